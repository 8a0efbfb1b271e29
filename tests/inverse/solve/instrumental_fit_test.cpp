#include "inverse/solve/instrumental_fit.h"

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
