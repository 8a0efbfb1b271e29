#include "inverse/transport/direct_light.h"

#include <gtest/gtest.h>

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::SurfaceSample;

TEST(DirectLight, UnoccludedIlluminationIsItsClosedForm) {
  const SurfaceSample at{{1, 2, 3}, {0, 1, 0}};
  EXPECT_NEAR(unoccluded_illumination(at, {1, 4, 3}), 1 / (4 * M_PI), 1e-7);
  EXPECT_NEAR(unoccluded_illumination(at, {4, 6, 3}), 0.8 / (25 * M_PI), 1e-8);
  EXPECT_EQ(unoccluded_illumination(at, {1, 1, 3}), 0);
  EXPECT_EQ(unoccluded_illumination(at, {5, 2, 3}), 0);
}

TEST(DirectLight, ASpotGivesWhatTheRendererGives) {
  const SurfaceSample at{{1, 2, 3}, {0, 1, 0}};
  renderer::SpotLight spot;
  spot.intensity = {1, 1, 1};
  spot.direction = normalize(renderer::Vec3f{-0.3F, -1, 0.2F});
  spot.inner_cone_angle = 0.4F;
  spot.outer_cone_angle = 0.7F;
  int within = 0, between = 0, outside = 0;
  for (int i = -4; i <= 4; ++i) {
    spot.position = {1 + 0.5F * float(i), 4, 3.3F};
    const auto expected = sample_punctual(spot, at.position);
    const DirectTerm term = unoccluded_term(at, {to_eigen(spot.position), spot_cone(spot)});
    EXPECT_NEAR(term.value, double(expected.irradiance.x * dot(expected.to_light, at.normal)) / M_PI, 1e-6);
    const double whole = unoccluded_term(at, to_eigen(spot.position)).value;
    within += term.value > 0.999 * whole ? 1 : 0;
    between += term.value > 0 && term.value < 0.999 * whole ? 1 : 0;
    outside += term.value == 0 ? 1 : 0;
  }
  EXPECT_GT(within, 0);
  EXPECT_GT(between, 0);
  EXPECT_GT(outside, 0);
}

TEST(DirectLight, GradientEqualsCentralDifferences) {
  const SurfaceSample at{{1, 2, 3}, normalize(renderer::Vec3f{0.2F, 1, -0.4F})};
  renderer::SpotLight spot;
  spot.direction = normalize(renderer::Vec3f{-0.3F, -1, 0.2F});
  spot.inner_cone_angle = 0.1F;
  spot.outer_cone_angle = 1;
  constexpr double kStep = 1e-3;
  for (const auto& cone : {std::optional<renderer::SpotCone>(), std::optional(spot_cone(spot))}) {
    const Vector3d x(1.4, 3.5, 3.1);
    const DirectTerm term = unoccluded_term(at, {x, cone});
    EXPECT_GT(term.value, 0);
    for (int a = 0; a < 3; ++a) {
      const double plus = unoccluded_term(at, {x + kStep * Vector3d::Unit(a), cone}).value;
      const double minus = unoccluded_term(at, {x - kStep * Vector3d::Unit(a), cone}).value;
      EXPECT_NEAR(term.gradient[a], (plus - minus) / (2 * kStep), 1e-3 * term.gradient.norm()) << "axis " << a;
    }
  }
}

TEST(DirectLight, ThereIsNoneBelowTheHorizon) {
  const DirectTerm term = unoccluded_term({{1, 2, 3}, {0, 1, 0}}, Vector3d(1, 1, 3));
  EXPECT_EQ(term.value, 0);
  EXPECT_EQ(term.gradient.norm(), 0);
}

}  // namespace
}  // namespace chiaro::inverse
