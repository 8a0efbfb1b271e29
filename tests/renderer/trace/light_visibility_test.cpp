#include "renderer/trace/light_visibility.h"

#include <cmath>

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

const Box3f kBox{{-1, 0, 2}, {3, 1, 4}};

TEST(LightVisibility, KnowsNothingBeforeItLearns) {
  LightVisibility visibility(kBox, 10);
  const std::size_t part = visibility.part_of({0, 0.5F, 3}, {0, 1, 0});
  visibility.record(part, 3, false);
  for (const float factor : visibility.factors(part)) EXPECT_EQ(factor, 1);
}

// √((seen + 1) / (all + 1)), and never below a twentieth.
TEST(LightVisibility, LearnsHowOftenALightIsSeen) {
  LightVisibility visibility(kBox, 10);
  const std::size_t part = visibility.part_of({0, 0.5F, 3}, {0, 1, 0});
  for (int k = 0; k < 19; ++k) visibility.record(part, 3, k < 4);
  for (int k = 0; k < 5000; ++k) visibility.record(part, 4, false);
  visibility.record(part, 5, true);
  visibility.learn();
  const auto factors = visibility.factors(part);
  EXPECT_FLOAT_EQ(factors[3], 0.5F);
  EXPECT_FLOAT_EQ(factors[4], 0.05F);
  EXPECT_FLOAT_EQ(factors[5], 1);
  EXPECT_FLOAT_EQ(factors[6], 1);
  for (int k = 0; k < 20; ++k) visibility.record(part, 3, true);
  visibility.learn();
  EXPECT_FLOAT_EQ(visibility.factors(part)[3], std::sqrt(25.0F / 40));
}

TEST(LightVisibility, PartsAreApartByPlaceAndByTheWayTheyFace) {
  LightVisibility visibility(kBox, 10);
  const Vec3f point{0, 0.5F, 3};
  const std::size_t part = visibility.part_of(point, {0, 1, 0});
  EXPECT_EQ(part, visibility.part_of(point + Vec3f{1e-4F, 0, 0}, normalize({0.2F, 0.9F, -0.2F})));
  EXPECT_NE(part, visibility.part_of(point, {0, -1, 0}));
  EXPECT_NE(part, visibility.part_of(point, {0, 0, 1}));
  EXPECT_NE(part, visibility.part_of(point + Vec3f{1, 0, 0}, {0, 1, 0}));
}

TEST(LightVisibility, EveryPointHasAPart) {
  for (const Box3f& box : {kBox, Box3f{{0, 0, 0}, {0, 0, 0}}, Box3f{{0, 5, 0}, {1e6F, 5, 1e-3F}}}) {
    for (const std::size_t lights : {1, 7, 256}) {
      LightVisibility visibility(box, lights);
      for (const Vec3f point : {box.min, box.max, box.center(), box.max + Vec3f{9, 9, 9}, box.min - Vec3f{9, 9, 9}}) {
        const std::size_t part = visibility.part_of(point, {0, 0, 0});
        visibility.record(part, lights - 1, true);
        EXPECT_GE(visibility.factors(part).size(), lights);
      }
      visibility.learn();
    }
  }
}

// 3 MB of factors at most, of flat and of long scenes, too.
TEST(LightVisibility, TakesLittleMemory) {
  for (const Vec3f extent : {Vec3f{1000, 1000, 10}, {1000, 1, 1}, {1, 1, 1}, {1e6F, 1e-3F, 0}, {3, 0, 2}}) {
    for (const std::size_t lights : {8, 256}) {
      const LightVisibility visibility({{0, 0, 0}, extent}, lights);
      const std::size_t parts = visibility.part_of(extent, {0, 0, -1}) + 1;  // the last
      EXPECT_LE(parts * lights, 750'000U) << extent.x << " " << lights;
      EXPECT_GE(parts * lights, 50'000U) << extent.x << " " << lights;
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer
