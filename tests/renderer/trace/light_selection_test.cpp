#include "renderer/trace/light_selection.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "renderer/trace/light_sampling.h"
#include "tests/support/directions.h"
#include "tests/support/environments.h"
#include "tests/support/mean.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer {
namespace {

using test::uniform_direction;

// Lights of all kinds in random places.
Lights mixed_lights(std::size_t count) {
  Lights lights{test::environment(test::environment_map(2, 1, [](int, int) { return Vec3f{1, 1, 1}; }))};
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(1, 0, i);
    const Vec2f xy = sampler.next_2d();
    const Vec3f at{6 * xy.x, 6 * xy.y, 6 * sampler.next_1d()}, way = uniform_direction(sampler.next_2d());
    const float i0 = 5 * sampler.next_1d();
    if (i % 3 == 0) lights.emplace_back(SpotLight{"", at, way, {i0, i0, 1}, 0.4F * xy.x, 0.5F + xy.y});
    if (i % 3 == 1) lights.emplace_back(PointLight{"", at, {i0, 1, i0}});
    if (i % 15 == 2) lights.emplace_back(DirectionalLight{"", way, {0.1F * i0, 0, 0}});
  }
  return lights;
}

// A dome.
Lights directional_lights(std::size_t count) {
  Lights lights;
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(1, 1, i);
    lights.emplace_back(DirectionalLight{"", uniform_direction(sampler.next_2d()), {0.1F, sampler.next_1d(), 0}});
  }
  return lights;
}

struct Count {
  const char* name;
  std::size_t lights;
  bool distant = false;  // all of them
};

// In the box of the lights, what shadow rays may have learnt: some lights are seen here and there.
void teach(const Lights& lights, LightVisibility& visibility) {
  for (std::uint32_t k = 0; k < 20000; ++k) {
    Sampler sampler(7, 0, k);
    const Vec2f xy = sampler.next_2d();
    const Vec3f point{6 * xy.x, 6 * xy.y, 6 * sampler.next_1d()};
    const auto light = std::size_t(sampler.next_1d() * float(lights.size()));
    visibility.record(visibility.part_of(point, uniform_direction(sampler.next_2d())), light, light % 3 == 0);
  }
  visibility.learn();
}

class LightSelectionOf : public testing::TestWithParam<Count> {
 protected:
  LightSelectionOf()
      : lights(GetParam().distant ? directional_lights(GetParam().lights) : mixed_lights(GetParam().lights)),
        visibility({{0, 0, 0}, {6, 6, 6}}, lights.size()) {
    teach(lights, visibility);
  }
  Lights lights;
  LightVisibility visibility;
  LightSelection ignorant{lights}, taught{lights, &visibility};
};

TEST_P(LightSelectionOf, PicksCarryTheirProbability) {
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const LightSelection& selection = k % 2 == 0 ? ignorant : taught;
    Sampler sampler(2, 0, k);
    const Vec2f xy = sampler.next_2d();
    const Vec3f point{6 * xy.x, 6 * xy.y, 3}, normal = uniform_direction(sampler.next_2d());
    const auto pick = selection.pick(point, normal, double(sampler.next_1d()));
    if (!(pick.probability > 0)) continue;
    EXPECT_FALSE(is_environment(lights[pick.light]));
    EXPECT_NEAR(selection.probability(pick.light, point, normal) / pick.probability, 1, 1e-4F);
  }
}

// E[irradiance / probability] is the irradiance of all lights together, to five standard errors (p < 0.0001 %).
TEST_P(LightSelectionOf, TheExpectationIsTheSumOverAllLights) {
  for (std::uint32_t k = 0; k < 12; ++k) {
    const LightSelection& selection = k % 2 == 0 ? ignorant : taught;
    Sampler where(3, 0, k / 2);
    const Vec2f xy = where.next_2d();
    const Vec3f point{6 * xy.x, 6 * xy.y, 3}, normal = uniform_direction(where.next_2d());
    const auto irradiance = [&](std::size_t i) {
      const PunctualSample s = sample_punctual(lights[i], point);
      return double(std::max(0.0F, dot(normal, s.to_light)) * luminance(s.irradiance));
    };
    double sum = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) sum += irradiance(i);
    test::Mean mean;
    for (std::uint32_t j = 0; j < 1U << 14; ++j) {
      const auto pick = selection.pick(point, normal, double(Sampler(4, k, j).next_1d()));
      mean.add(pick.probability > 0 ? irradiance(pick.light) / double(pick.probability) : 0);
    }
    EXPECT_NEAR(mean.value(), sum, 5 * mean.error() + 1e-5 * sum) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, LightSelectionOf,
                         testing::Values(Count{"One", 1}, Count{"Few", 4}, Count{"Eight", 8}, Count{"Many", 40},
                                         Count{"TwoHundred", 200}, Count{"Thousand", 1000}, Count{"Dome", 200, true},
                                         Count{"FineDome", 310, true}),
                         test::kByName);

TEST(LightSelection, WeighsByTheIrradiance) {
  const Lights lights = mixed_lights(200);
  const LightSelection selection(lights);
  LightSelection::Weights weights;
  for (std::uint32_t k = 0; k < 50; ++k) {
    Sampler sampler(5, 0, k);
    const Vec2f xy = sampler.next_2d();
    const Vec3f point{6 * xy.x, 6 * xy.y, 3}, normal = uniform_direction(sampler.next_2d());
    selection.weigh(point, normal, weights);
    for (std::size_t i = 0; i < selection.lights_in_order().size(); ++i) {
      const PunctualSample s = sample_punctual(lights[selection.lights_in_order()[i]], point);
      const float expected = std::max(0.0F, dot(normal, s.to_light)) * max_component(s.irradiance);
      EXPECT_NEAR(weights.of_light[i], expected, 1e-3F * expected + 1e-6F) << k << " " << i;
    }
  }
}

TEST(LightSelection, ChangesItsWaysBeyondAFew) {
  EXPECT_TRUE(LightSelection({}).few());
  const Lights four(4, PointLight{"", {1, 2, 3}, {1, 1, 1}}), five(5, PointLight{"", {1, 2, 3}, {1, 1, 1}});
  EXPECT_TRUE(LightSelection(four).few());
  EXPECT_FALSE(LightSelection(five).few());
  const Lights hundreds(257, PointLight{"", {1, 2, 3}, {1, 1, 1}});
  EXPECT_TRUE(LightSelection(five).weighs_all());
  EXPECT_FALSE(LightSelection(hundreds).weighs_all());
}

}  // namespace
}  // namespace chiaro::renderer
