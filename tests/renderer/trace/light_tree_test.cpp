#include "renderer/trace/light_tree.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/support/directions.h"
#include "tests/support/mean.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer {
namespace {

using test::Mean;
using test::uniform_direction;

Vec3f point_in_cube(Sampler& sampler) {
  const Vec2f xy = sampler.next_2d();
  return {10 * xy.x - 5, 10 * xy.y - 5, 10 * sampler.next_1d() - 5};
}

LightBounds point_light(Sampler& sampler) {
  LightBounds bounds;
  bounds.box.extend(point_in_cube(sampler));
  bounds.intensity = sampler.next_1d() < 0.1F ? 0.0F : std::exp(4 * sampler.next_1d());
  return bounds;
}

LightBounds spot_light(Sampler& sampler) {
  LightBounds bounds = point_light(sampler);
  bounds.axis = uniform_direction(sampler.next_2d());
  bounds.spread = 0.5F * sampler.next_1d();
  bounds.emission = 0.9F * sampler.next_1d();
  return bounds;
}

LightBounds triangle(Sampler& sampler) {
  LightBounds bounds = spot_light(sampler);
  for (int k = 0; k < 2; ++k) bounds.box.extend(bounds.box.min + 0.5F * uniform_direction(sampler.next_2d()));
  bounds.spread = 0;
  bounds.emission = kPi / 2;
  bounds.two_sided = true;
  return bounds;
}

struct Kind {
  const char* name;
  LightBounds (*make)(Sampler&);
  std::size_t count;
  bool in_one_place = false;
};

std::vector<LightBounds> lights_of(const Kind& kind) {
  std::vector<LightBounds> lights;
  for (std::uint32_t i = 0; i < kind.count; ++i) {
    Sampler sampler(5, 1, i);
    lights.push_back(kind.make(sampler));
    if (kind.in_one_place) lights.back().box = lights.front().box;
  }
  return lights;
}

// Irradiance that a light brings from the middle of its box.
float brought_by(const LightBounds& light, Vec3f point, Vec3f normal) {
  const Vec3f d = light.box.center() - point, way = normalize(d);
  float facing = -dot(light.axis, way);
  if (light.two_sided) facing = std::abs(facing);
  const float off = std::max(0.0F, std::acos(std::clamp(facing, -1.0F, 1.0F)) - light.spread);
  if (off >= light.emission) return 0;
  return light.intensity * std::cos(off) * std::max(0.0F, dot(normal, way)) / length_squared(d);
}

class LightTreeOf : public testing::TestWithParam<Kind> {};

TEST_P(LightTreeOf, ProbabilitiesAndFailuresAddUpToOne) {
  const std::vector<LightBounds> lights = lights_of(GetParam());
  const LightTree tree(lights);
  for (std::uint32_t k = 0; k < 20; ++k) {
    Sampler sampler(6, 0, k);
    const Vec3f point = point_in_cube(sampler);
    const Vec3f normal = k % 4 == 0 ? Vec3f{} : uniform_direction(sampler.next_2d());
    double sum = 0;
    for (std::uint32_t i = 0; i < lights.size(); ++i) sum += double(tree.probability(i, point, normal));
    // Stratified picks tell the probability of none to 1 in their number, per border between picks and failures.
    constexpr int kPicks = 4096;
    int failures = 0;
    for (int j = 0; j < kPicks; ++j) failures += tree.pick(point, normal, (j + 0.5) / kPicks) ? 0 : 1;
    EXPECT_NEAR(sum + double(failures) / kPicks, 1, 0.01) << k;
    if (normal == Vec3f{} && GetParam().make == point_light) {
      EXPECT_NEAR(sum, 1, 1e-5);
    }
  }
}

TEST_P(LightTreeOf, PicksCarryTheirProbability) {
  const std::vector<LightBounds> lights = lights_of(GetParam());
  const LightTree tree(lights);
  for (std::uint32_t k = 0; k < 2000; ++k) {
    Sampler sampler(7, 0, k);
    const Vec3f point = point_in_cube(sampler), normal = uniform_direction(sampler.next_2d());
    const auto pick = tree.pick(point, normal, double(sampler.next_1d()));
    if (!pick) continue;
    ASSERT_GT(pick->probability, 0);
    EXPECT_GT(lights[pick->light].intensity, 0);
    EXPECT_NEAR(tree.probability(pick->light, point, normal) / pick->probability, 1, 1e-4F);
  }
}

TEST_P(LightTreeOf, NoLightThatReachesThePointIsOutOfReach) {
  const std::vector<LightBounds> lights = lights_of(GetParam());
  const LightTree tree(lights);
  for (std::uint32_t k = 0; k < 200; ++k) {
    Sampler sampler(8, 0, k);
    const Vec3f point = point_in_cube(sampler), normal = uniform_direction(sampler.next_2d());
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      // A little more than nothing: at the very edge of a cone rounding decides.
      if (brought_by(lights[i], point, normal) > 1e-3F) {
        EXPECT_GT(tree.probability(i, point, normal), 0) << k << " " << i;
      }
    }
  }
}

// E[value / probability] is the sum over all lights, to five standard errors (p < 0.0001 %).
TEST_P(LightTreeOf, TheExpectationIsTheSumOverAllLights) {
  const std::vector<LightBounds> lights = lights_of(GetParam());
  const LightTree tree(lights);
  for (std::uint32_t k = 0; k < 5; ++k) {
    Sampler where(9, 0, k);
    const Vec3f point = point_in_cube(where), normal = uniform_direction(where.next_2d());
    double sum = 0;
    for (const LightBounds& light : lights) sum += double(brought_by(light, point, normal));
    Mean mean;
    for (std::uint32_t j = 0; j < 1U << 14; ++j) {
      const auto pick = tree.pick(point, normal, double(Sampler(10, k, j).next_1d()));
      mean.add(pick ? double(brought_by(lights[pick->light], point, normal)) / double(pick->probability) : 0);
    }
    EXPECT_NEAR(mean.value(), sum, 5 * mean.error() + 1e-5 * sum) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, LightTreeOf,
                         testing::Values(Kind{"ThousandPoints", point_light, 1000},
                                         Kind{"HundredSpots", spot_light, 100},
                                         Kind{"ThousandTriangles", triangle, 1000}, Kind{"TwoPoints", point_light, 2},
                                         Kind{"PointsInOnePlace", point_light, 50, true}),
                         test::kByName);

// Picking by bounds is worth its while: far less spread than picking by intensity alone.
TEST(LightTree, BoundsKeepTheSpreadLow) {
  const std::vector<LightBounds> lights = lights_of({"", point_light, 1000});
  const LightTree tree(lights);
  double total = 0, tree_spread = 0, power_spread = 0;
  for (const LightBounds& light : lights) total += double(light.intensity);
  for (std::uint32_t k = 0; k < 20; ++k) {
    Sampler where(11, 0, k);
    const Vec3f point = point_in_cube(where), normal = uniform_direction(where.next_2d());
    double sum = 0, by_tree = 0, by_power = 0;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      const double value = double(brought_by(lights[i], point, normal)), p = double(tree.probability(i, point, normal));
      sum += value;
      if (value > 0) by_tree += value * value / p, by_power += value * value / (double(lights[i].intensity) / total);
    }
    tree_spread += by_tree / (sum * sum) - 1;
    power_spread += by_power / (sum * sum) - 1;
  }
  EXPECT_LT(tree_spread, 0.3 * power_spread);
  RecordProperty("relative_variance_by_tree", std::to_string(tree_spread / 20));
  RecordProperty("relative_variance_by_intensity", std::to_string(power_spread / 20));
}

TEST(LightTree, IsEmptyWithoutLights) {
  EXPECT_TRUE(LightTree().empty());
  EXPECT_TRUE(LightTree({LightBounds{}}).empty());
  EXPECT_FALSE(LightTree(std::vector<LightBounds>{}).pick({}, {0, 1, 0}, 0.5).has_value());
}

TEST(LightTree, StaysFiniteAtALight) {
  std::vector<LightBounds> lights = lights_of({"", point_light, 20});
  const LightTree tree(lights);
  for (const LightBounds& light : lights) {
    for (const float step : {0.0F, 1e-30F, 1e-6F}) {
      const Vec3f point = light.box.min + Vec3f{step, 0, 0};
      float sum = 0;
      for (std::uint32_t i = 0; i < lights.size(); ++i) sum += tree.probability(i, point, {});
      EXPECT_LE(sum, 1.0001F);
      if (const auto pick = tree.pick(point, {}, 0.3)) {
        EXPECT_TRUE(std::isfinite(pick->probability));
      }
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer
