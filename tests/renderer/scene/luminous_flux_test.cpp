#include "renderer/scene/luminous_flux.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "renderer/trace/light_sampling.h"

namespace chiaro::renderer {
namespace {

TEST(LuminousFlux, OfAPointLightIsFourPiTimesItsIntensity) {
  EXPECT_NEAR(*luminous_flux(PointLight{"", {}, {100, 100, 100}}), 1256.64, 0.01);
  EXPECT_NEAR(*luminous_flux(PointLight{"", {}, {0, 100, 0}}), 0.7152 * 1256.64, 0.1);
}

// Against the sum over directions of what surfaces get from it.
TEST(LuminousFlux, OfASpotLightIsWhatItSendsIntoItsCone) {
  const SpotLight light{"", {}, {0, 0, -1}, {7, 7, 7}, 0.3F, 0.9F};
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = 1 - 2 * (i + 0.5) / kSteps, sine = std::sqrt(1 - cosine * cosine);
    const Vec3f point{float(sine), 0, float(-cosine)};
    sum += double(luminance(sample_punctual(light, point).irradiance)) * 4 * std::numbers::pi / kSteps;
  }
  EXPECT_NEAR(*luminous_flux(light) / sum, 1, 1e-3);
}

TEST(LuminousFlux, IsNotOfLightFromAfar) {
  EXPECT_FALSE(luminous_flux(DirectionalLight{}));
  EXPECT_FALSE(luminous_flux(EnvironmentLight{}));
}

}  // namespace
}  // namespace chiaro::renderer
