#include "inverse/solve/settling_bench.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

// One of ten receivers is bright; each is known to a twentieth of its brightness, and counts by that.
Observations few_bright_ones(Eigen::Index receivers) {
  Observations observations;
  observations.wanted = Column::Constant(receivers, 3, 0.01);
  for (Eigen::Index i = 0; i < receivers; i += 10) observations.wanted.row(i).setConstant(1);
  observations.target = observations.wanted;
  observations.stands_for = Eigen::VectorXd::Ones(receivers);
  observations.standard_error = 0.05 * observations.wanted.col(0);
  observations.sqrt_weight = observations.standard_error.cwiseInverse();
  observations.measure_target();
  return observations;
}

// Bright and dark ones differ from what is wanted by so many standard errors.
Column differing(const Observations& observations, double bright, double dark) {
  Column brought = observations.wanted;
  for (Eigen::Index i = 0; i < brought.rows(); ++i) {
    brought.row(i).array() += observations.standard_error[i] * (i % 10 == 0 ? bright : dark);
  }
  return brought;
}

TEST(SettlingBench, ReceiversWhoseNoiseIsKnownTellByThat) {
  const DirectProblem problem(known_lights(1));
  const SettlingBench bench{problem.response(), few_bright_ones(1000)};
  const Column near = differing(bench.observations, 0.1, 0.02), far = differing(bench.observations, 1, 0);
  EXPECT_TRUE(bench.explains_more(near, far, 0.01, 3));
  EXPECT_FALSE(bench.explains_more(far, near, 0.01, 3));
}

// One is nearer to what is wanted nearly everywhere, and has a few in shadow that the target has lit.
TEST(SettlingBench, AFewFarBeyondNoiseDoNotDecideForMost) {
  const DirectProblem problem(known_lights(1));
  const SettlingBench bench{problem.response(), few_bright_ones(1000)};
  Column near = differing(bench.observations, 0.5, 0.5);
  const Column far = differing(bench.observations, 1.5, 1.5);
  for (const Eigen::Index i : {100, 350, 720}) near.row(i).array() += 200 * bench.observations.standard_error[i];
  EXPECT_FALSE(bench.explains_more(near, far, 0.01, 3));
  EXPECT_TRUE(bench.explains_more_to_most(near, far, 0.01, 3));
  EXPECT_FALSE(bench.explains_more_to_most(far, near, 0.01, 3));
  const Observations weighted = bench.as_most_say(near);
  EXPECT_LT(weighted.sqrt_weight[350], 1e-2 * bench.observations.sqrt_weight[350]);
  EXPECT_GT(weighted.sqrt_weight[351], 0.9 * bench.observations.sqrt_weight[351]);
}

}  // namespace
}  // namespace chiaro::inverse
