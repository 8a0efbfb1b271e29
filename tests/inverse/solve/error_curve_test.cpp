#include "inverse/solve/error_curve.h"

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

LightSet lit(std::size_t lights, double relative_l2) {
  LightEstimates set(lights, {{0, 1, 0}, {8, 4, 2}});
  for (std::size_t j = 0; j < lights; ++j) set[j].position.x() = double(j);
  return set_of(set, relative_l2);
}

double total(const LightSet& set) {
  double sum = 0;
  for (const renderer::PointLight& light : set.lights) sum += double(light.intensity.x);
  return sum;
}

TEST(ErrorCurve, HasASetOfEverySize) {
  std::vector<LightSet> curve{lit(1, 0.5), lit(2, 0.2), lit(5, 0.1), lit(6, 0.3)};
  let_none_be_worse_than_fewer(curve);
  ASSERT_EQ(curve.size(), 6U);
  const double expected[] = {0.5, 0.2, 0.2, 0.2, 0.1, 0.1}, shining[] = {8, 16, 16, 16, 40, 40};
  for (std::size_t k = 0; k < curve.size(); ++k) {
    EXPECT_EQ(curve[k].lights.size(), k + 1);
    EXPECT_EQ(curve[k].relative_l2, expected[k]) << k;
    EXPECT_FLOAT_EQ(float(total(curve[k])), float(shining[k])) << k;
  }
}

TEST(ErrorCurve, SetsTakeThePlaceOfThoseOfAsMany) {
  std::vector<LightSet> curve{lit(1, 0.5), lit(3, 0.2)};
  put_in_curve(lit(3, 0.1), curve);
  put_in_curve(lit(2, 0.4), curve);
  put_in_curve({}, curve);
  ASSERT_EQ(curve.size(), 3U);
  for (std::size_t k = 0; k < curve.size(); ++k) EXPECT_EQ(curve[k].lights.size(), k + 1);
  EXPECT_EQ(curve[2].relative_l2, 0.1);
}

}  // namespace
}  // namespace chiaro::inverse
