#include "inverse/solve/important_vertices.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using tests::known_lights;
using tests::PaintedCorner;

class ImportantVertices : public ::testing::Test {
 protected:
  Importance choose(const Target& target, int count, std::uint64_t seed = 1) const {
    ImportanceOptions options;
    options.count = count;
    options.seed = seed;
    return choose_important_vertices(corner_.tracer(), target, options);
  }

  const PaintedCorner corner_;
  const Target target_ = corner_.target(known_lights(1), 0);
};

TEST_F(ImportantVertices, AreDistinctAscendingAndAsManyAsAsked) {
  const Importance importance = choose(target_, 300);
  ASSERT_EQ(importance.chosen.size(), 300U);
  for (std::size_t k = 1; k < 300; ++k) EXPECT_LT(importance.chosen[k - 1], importance.chosen[k]);
  EXPECT_LT(importance.chosen.back(), target_.receivers.size());
}

TEST_F(ImportantVertices, AreNeverThoseOfNoWeight) {
  Target target = target_;
  for (std::size_t i = 0; i < target.weight.size(); ++i) target.weight[i] = i % 3 == 0 ? 0.5F : 0;
  const auto painted = std::size_t(std::count(target.weight.begin(), target.weight.end(), 0.5F));
  for (const int count : {50, int(painted), 100000}) {
    const Importance importance = choose(target, count);
    EXPECT_EQ(importance.chosen.size(), std::min(std::size_t(count), painted));
    for (const std::size_t i : importance.chosen) EXPECT_GT(target.weight[i], 0);
  }
}

// A hundredth of all is lit: as many of them are drawn as are worth it, and stand for as many as there are.
TEST_F(ImportantVertices, PoolsOfLightAreNotMissed) {
  Target target = target_;
  const auto is_lit = [](std::size_t i) { return i % 100 == 7; };
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    target.illumination[i] = is_lit(i) ? Vec3f{1, 1, 1} : Vec3f{};
    target.weight[i] = is_lit(i) ? 1 : 0.05F;
  }
  double stand_for = 0, all = 0;
  constexpr int kSeeds = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Importance importance = choose(target, 100, std::uint64_t(seed));
    int lit = 0;
    for (std::size_t k = 0; k < importance.chosen.size(); ++k) {
      if (!is_lit(importance.chosen[k])) continue;
      ++lit;
      stand_for += 1 / importance.probability[k];
    }
    EXPECT_GE(lit, 10) << seed;
  }
  for (std::size_t i = 0; i < target.receivers.size(); ++i) all += is_lit(i) ? kSeeds : 0;
  EXPECT_NEAR(stand_for / all, 1, 0.15);
}

TEST_F(ImportantVertices, DependOnTheirSeedAndNothingElse) {
  const auto first = choose(target_, 300).chosen;
  const renderer::ThreadLimit limit(1);
  EXPECT_EQ(choose(target_, 300).chosen, first);
  EXPECT_NE(choose(target_, 300, 2).chosen, first);
}

TEST_F(ImportantVertices, AreChosenAgainByTheSameImportance) {
  const Importance few = choose(target_, 100), many = choose(target_, 300);
  const Importance again = choose_again(few, target_, 300, 1);
  EXPECT_EQ(again.chosen, many.chosen);
  EXPECT_EQ(again.probability, many.probability);
  EXPECT_EQ(again.total, few.total);
  EXPECT_NE(choose_again(few, target_, 300, 2).chosen, many.chosen);
}

TEST_F(ImportantVertices, ArePlacedWhereTheImportanceIs) {
  const Importance importance = choose(target_, 300);
  double mean = 0, chosen = 0;
  for (const double v : importance.total) mean += v / double(importance.total.size());
  for (const std::size_t i : importance.chosen) chosen += importance.total[i] / 300;
  EXPECT_GT(chosen, 1.1 * mean);
  for (std::size_t i = 0; i < importance.total.size(); ++i) {
    ASSERT_TRUE(importance.geometry[i] >= 0 && importance.geometry[i] <= 1);
    ASSERT_TRUE(importance.illumination[i] >= 0 && importance.illumination[i] <= 1);
    EXPECT_NEAR(importance.total[i], importance.geometry[i] + importance.illumination[i], 1e-12);
  }
}

TEST_F(ImportantVertices, GeometryCountsCornersAndIlluminationCountsShadowEdges) {
  const Importance importance = choose(target_, 300);
  double corner = 0, open = 0;
  int corners = 0, opens = 0;
  for (std::size_t i = 0; i < target_.receivers.size(); ++i) {
    const Vec3f p = target_.receivers.positions[i];
    if (p.y > 1e-5F) continue;
    if (p.x < 0.3F && p.z < 0.3F) corner += importance.geometry[i], ++corners;
    if (p.x > 3.5F && p.z > 3.5F) open += importance.geometry[i], ++opens;
  }
  ASSERT_TRUE(corners > 0 && opens > 0);
  EXPECT_GT(corner / corners, 1.2 * open / opens);
  // Where the light does not change, the illumination term is 0.
  Target flat = target_;
  flat.illumination.assign(flat.illumination.size(), Vec3f{2, 2, 2});
  for (const double v : choose(flat, 100).illumination) EXPECT_NEAR(v, 0, 1e-9);
}

}  // namespace
}  // namespace chiaro::inverse
