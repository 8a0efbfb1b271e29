// Monte Carlo integrals over directions; bounds are five standard errors (p < 0.0001 %). Seeds are fixed.

#include "renderer/trace/environment_sampling.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/support/directions.h"
#include "tests/support/environments.h"
#include "tests/support/mean.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer {
namespace {

using test::environment;
using test::Mean;
using test::uniform_direction;

struct NamedMap {
  const char* name;
  EnvironmentMap (*make)();
};

// Contrasts of 1 to 50 along and across, so that all of the sphere counts in an integral of uniform directions.
EnvironmentMap uneven_map() {
  return test::environment_map(16, 8, [](int x, int y) {
    const float v = 1 + float((7 * x + 3 * y) % 50);
    return Vec3f{v, 0.5F * v, 2};
  });
}
EnvironmentMap constant_map() {
  return test::environment_map(32, 16, [](int, int) { return Vec3f{3, 2, 1}; });
}
EnvironmentMap one_pixel_map() {
  return test::environment_map(16, 8, [](int x, int y) { return x == 3 && y == 2 ? Vec3f{9, 9, 9} : Vec3f{}; });
}
EnvironmentMap single_row_map() {
  return test::environment_map(5, 1, [](int x, int) { return Vec3f{float(x), 1, 1}; });
}
EnvironmentMap single_pixel_map() {
  return test::environment_map(1, 1, [](int, int) { return Vec3f{1, 1, 1}; });
}
EnvironmentMap bright_pole_map() {
  return test::environment_map(16, 8, [](int x, int y) {
    return y == 0 ? Vec3f{100, 100, 100 + float(x)} : Vec3f{1, 1, 1};
  });
}

class EnvironmentSamplingOf : public testing::TestWithParam<NamedMap> {};

TEST_P(EnvironmentSamplingOf, DensityIntegratesToOne) {
  const EnvironmentLight light = environment(GetParam().make(), 0.7F);
  const EnvironmentSampling sampling(light);
  Mean mean;
  for (std::uint32_t k = 0; k < 1U << 16; ++k) {
    mean.add(4 * M_PI * double(sampling.pdf(uniform_direction(Sampler(1, 0, k).next_2d()))));
  }
  EXPECT_NEAR(mean.value(), 1, 5 * mean.error() + 1e-4);
}

TEST_P(EnvironmentSamplingOf, SamplesCarryTheirOwnDensityAndRadiance) {
  const EnvironmentLight light = environment(GetParam().make(), 0.7F);
  const EnvironmentSampling sampling(light);
  int at_a_border = 0;
  for (std::uint32_t k = 0; k < 1U << 12; ++k) {
    const auto s = sampling.sample(Sampler(2, 0, k).next_2d());
    ASSERT_NEAR(length(s.direction), 1, 1e-5F);
    ASSERT_GT(s.pdf, 0);
    EXPECT_EQ(s.radiance, sampling.radiance(s.direction));
    at_a_border += std::abs(sampling.pdf(s.direction) / s.pdf - 1) > 1e-4F ? 1 : 0;
  }
  EXPECT_LE(at_a_border, 4);
}

// With MIS, as the path tracer uses it: E[L / (pdf + uniform)] over both kinds of directions is ∫ L.
TEST_P(EnvironmentSamplingOf, WithUniformDirectionsFindsAllLight) {
  const EnvironmentLight light = environment(GetParam().make(), 0.7F);
  const EnvironmentSampling sampling(light);
  constexpr double kUniform = 1 / (4 * M_PI);
  Mean by_uniform, by_both;
  for (std::uint32_t k = 0; k < 1U << 16; ++k) {
    Sampler sampler(3, 0, k);
    const Vec3f direction = uniform_direction(sampler.next_2d());
    const double radiance = double(luminance(sampling.radiance(direction)));
    const auto s = sampling.sample(sampler.next_2d());
    by_uniform.add(radiance / kUniform);
    by_both.add(radiance / (kUniform + double(sampling.pdf(direction))) +
                double(luminance(s.radiance)) / (kUniform + double(s.pdf)));
  }
  EXPECT_NEAR(by_both.value(), by_uniform.value(), 5 * (by_both.error() + by_uniform.error()) + 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Maps, EnvironmentSamplingOf,
                         testing::Values(NamedMap{"Uneven", uneven_map}, NamedMap{"Constant", constant_map},
                                         NamedMap{"OnePixel", one_pixel_map}, NamedMap{"SingleRow", single_row_map},
                                         NamedMap{"SinglePixel", single_pixel_map},
                                         NamedMap{"BrightPole", bright_pole_map}),
                         test::kByName);

TEST(EnvironmentSampling, RadianceIsThePixelTimesTheIntensityTurned) {
  EnvironmentLight light = environment(one_pixel_map(), 0);
  light.intensity = 2;
  const Vec3f middle = direction_of_latlong({3.5F / 16, 2.5F / 8});
  EXPECT_NEAR(EnvironmentSampling(light).radiance(middle).x, 18, 1e-3);
  light.rotation = 1.1F;
  EXPECT_NEAR(EnvironmentSampling(light).radiance(rotate_about_y(middle, 1.1F)).x, 18, 1e-3);
}

}  // namespace
}  // namespace chiaro::renderer
