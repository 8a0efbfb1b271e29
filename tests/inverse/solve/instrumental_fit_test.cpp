#include "inverse/solve/instrumental_fit.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

std::vector<Column> none(std::size_t lights, Eigen::Index receivers) {
  return std::vector<Column>(lights, Column::Zero(receivers, 3));
}

LightEstimates displaced(LightEstimates lights, double metres) {
  for (LightEstimate& light : lights) light.position += metres * Vector3d(0.6, -0.64, 0.48);
  return lights;
}

// Each receiver up to this part brighter or darker.
Observations with_noise(Observations observations, double part, std::uint32_t seed) {
  for (Eigen::Index i = 0; i < observations.wanted.rows(); ++i) {
    renderer::Sampler sampler(seed, 0, std::uint32_t(i));
    for (int c = 0; c < 3; ++c) observations.wanted(i, c) *= 1 + part * (2 * double(sampler.next_1d()) - 1);
  }
  return observations;
}

TEST(InstrumentalFit, FindsWhatMadeTheTarget) {
  const LightEstimates known = known_lights(3);
  const DirectProblem problem(known);
  const std::vector<Column> indirect = none(3, problem.observations().wanted.rows());
  LightEstimates lights = displaced(known, 0.1);
  descend_with_instruments(problem.response(), problem.observations(), indirect, lights);
  fit_intensities_with_instruments(problem.response(), problem.observations(), indirect, lights);
  EXPECT_LT(farthest_from(known, positions_of(lights)), 0.001);
  for (std::size_t j = 0; j < known.size(); ++j) EXPECT_TRUE(lights[j].intensity.isApprox(known[j].intensity, 0.002));
}

// A few receivers far too bright, all others a little too dark, and right on average.
Observations with_fireflies(Observations observations, std::uint32_t seed) {
  for (Eigen::Index i = 0; i < observations.wanted.rows(); ++i) {
    renderer::Sampler sampler(seed, 0, std::uint32_t(i));
    const double change = sampler.next_1d() < 0.02F ? 1.0 : -0.02 / 0.98;
    observations.wanted.row(i) *= 1 + change;
    observations.standard_error[i] = std::sqrt(0.02 / 0.98 / 3) * observations.wanted.row(i).norm();
  }
  observations.measure_target();
  return observations;
}

// Two standard errors of the mean of 40 seeds are 0.4 %. Without its fireflies, a target is 2 % too dark.
TEST(InstrumentalFit, FirefliesArePartOfNoiseThatIsKnown) {
  const LightEstimates known = known_lights(1);
  const DirectProblem problem(known, 1000);
  const std::vector<Column> indirect = none(1, problem.observations().wanted.rows());
  double mean = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    LightEstimates lights = known;
    fit_intensities_with_instruments(problem.response(), with_fireflies(problem.observations(), seed), indirect,
                                     lights);
    mean += lights[0].intensity[1] / known[0].intensity[1] / 40;
  }
  EXPECT_NEAR(mean, 1, 0.008);
}

// A floor that a light above it shines upon, and roofs above and below that turn their backs to it.
renderer::Scene mostly_dark() {
  renderer::Scene scene;
  const renderer::Material grey = test::lambert({0.5F, 0.5F, 0.5F});
  test::add_mesh(scene, test::rectangle({0, 0, 0}, {0, 0, 2}, {2, 0, 0}, 10), grey, "floor");
  test::add_mesh(scene, test::rectangle({-2, -1, -2}, {6, 0, 0}, {0, 0, 6}, 30), grey, "below");
  test::add_mesh(scene, test::rectangle({-2, 2, -2}, {0, 0, 6}, {6, 0, 0}, 30), grey, "above");
  return scene;
}

// Most receivers are dark, and would say that nothing is left anywhere, so that every lit one that leaves a little is
// far beyond it and hardly counts.
TEST(InstrumentalFit, DarkReceiversDoNotMakeLitOnesOutliers) {
  const LightEstimates known{{{1.2, 1.1, 0.9}, {9, 7, 5}}};
  const DirectProblem problem(known, 1000, mostly_dark());
  ASSERT_GT((problem.observations().wanted.col(0).array() <= 0).count(), 600);
  const std::vector<Column> indirect = none(1, problem.observations().wanted.rows());
  double farthest = 0;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    LightEstimates lights = displaced(known, 0.1);
    descend_with_instruments(problem.response(), with_noise(problem.observations(), 0.2, seed), indirect, lights);
    farthest = std::max(farthest, farthest_from(known, positions_of(lights)));
  }
  EXPECT_LT(farthest, 0.1);
}

// Visibility is held during a step: one over a shadow's edge is led back by what is seen beyond, and so on.
TEST(InstrumentalFit, ComesToRestBesideShadowsEdges) {
  const LightEstimates known = known_lights(3);
  const DirectProblem problem(known, 1000);
  const std::vector<Column> indirect = none(3, problem.observations().wanted.rows());
  int restless = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Observations noisy = with_noise(problem.observations(), 0.2, seed);
    LightEstimates once = displaced(known, 0.05);
    descend_with_instruments(problem.response(), noisy, indirect, once);
    LightEstimates twice = once;
    descend_with_instruments(problem.response(), noisy, indirect, twice);
    restless += farthest_from(once, positions_of(twice)) > 2e-4 * problem.diagonal() ? 1 : 0;
  }
  EXPECT_LE(restless, 2) << "of 40";
}

}  // namespace
}  // namespace chiaro::inverse
