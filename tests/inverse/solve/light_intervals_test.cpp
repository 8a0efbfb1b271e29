#include "inverse/solve/light_intervals.h"

#include <gtest/gtest.h>

#include <random>

#include "inverse/solve/refine_joint.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using tests::DirectProblem;
using tests::known_lights;
using tests::Vector3d;

constexpr JointRefinementOptions kToTheEnd{.max_iterations = 50, .function_tolerance = 1e-12};

Observations with_noise(Observations observations, double deviation, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < observations.wanted.rows(); ++i) {
    // Bright receivers are noisier, which the intervals find out by themselves.
    const double here = deviation * observations.target.row(i).norm();
    for (int c = 0; c < 3; ++c) observations.wanted(i, c) += here * normal(random);
  }
  return observations;
}

// Each of 480 parameters is within its interval with a chance of 0.9. Those of a light hang together, so that they
// count as a third as many: by chance less than 0.8 or more than 0.98 are inside in fewer than one of a thousand runs.
TEST(LightIntervals, HoldTheTruthNineTimesOfTen) {
  const LightEstimates known = known_lights(2);
  const DirectProblem problem(known);
  int inside = 0, all = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    const Observations noisy = with_noise(problem.observations(), 0.02, trial);
    const LightEstimates lights = refine_joint(problem.response(), noisy, known, kToTheEnd).lights;
    const std::vector<LightInterval> intervals = light_intervals(problem.response(), noisy, lights).lights;
    ASSERT_EQ(intervals.size(), lights.size());
    for (std::size_t j = 0; j < lights.size(); ++j) {
      for (int a = 0; a < 3; ++a) {
        inside += std::abs(lights[j].position[a] - known[j].position[a]) <= intervals[j].position[a] ? 1 : 0;
        inside += std::abs(lights[j].intensity[a] - known[j].intensity[a]) <= intervals[j].intensity[a] ? 1 : 0;
        all += 2;
      }
    }
  }
  EXPECT_GT(inside, 0.8 * all);
  EXPECT_LT(inside, 0.98 * all);
}

TEST(LightIntervals, GrowWithTheNoise) {
  const LightEstimates known = known_lights(1);
  const DirectProblem problem(known);
  const LightInterval some =
      light_intervals(problem.response(), with_noise(problem.observations(), 0.01, 1), known).lights[0];
  const LightInterval more =
      light_intervals(problem.response(), with_noise(problem.observations(), 0.04, 1), known).lights[0];
  EXPECT_TRUE(more.position.isApprox(4 * some.position, 1e-3));
  EXPECT_TRUE(more.intensity.isApprox(4 * some.intensity, 1e-3));
}

TEST(LightIntervals, AreInfiniteWhereNothingIsKnown) {
  LightEstimates lights = known_lights(1);
  const DirectProblem problem(lights);
  lights.push_back({{2, 1.5, 2}, Eigen::Array3d::Zero()});  // dark wherever it stands
  const std::vector<LightInterval> intervals =
      light_intervals(problem.response(), with_noise(problem.observations(), 0.01, 1), lights).lights;
  EXPECT_TRUE(intervals[0].position.allFinite());
  EXPECT_TRUE(std::isinf(intervals[1].position.minCoeff()));
  EXPECT_TRUE(intervals[1].intensity.allFinite());
  EXPECT_TRUE(light_intervals(problem.response(), problem.observations(), {}).lights.empty());
}

// Of two in one place the sum alone is known, as exactly as one light would be: of each by itself nothing.
TEST(LightIntervals, OfTwoLightsInOnePlaceNothingIsKnown) {
  LightEstimates lights = known_lights(1);
  lights[0].intensity /= 2;
  lights.push_back(lights[0]);
  const DirectProblem problem(lights);
  const LightIntervals intervals =
      light_intervals(problem.response(), with_noise(problem.observations(), 0.01, 1), lights);
  for (const LightInterval& interval : intervals.lights) {
    EXPECT_TRUE(std::isinf(interval.position.minCoeff()));
    EXPECT_TRUE(std::isinf(interval.intensity.minCoeff()));
  }
  EXPECT_EQ(intervals.confounded.size(), 1U);
}

TEST(LightIntervals, OfLightsInTwoPlacesEachPlacesSumIsKnown) {
  LightEstimates lights = known_lights(2);
  for (LightEstimate& light : lights) light.intensity /= 3;
  lights.push_back(lights[0]);
  lights.push_back(lights[1]);
  lights.push_back(lights[1]);
  const DirectProblem problem(lights);
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(light_intervals(problem.response(), with_noise(problem.observations(), 0.01, 1), lights).confounded,
            (Pairs{{0, 2}, {1, 3}, {1, 4}, {3, 4}}));
}

TEST(LightIntervals, ASumIsKnownOnlyIfItIsKnownBetterThanEach) {
  EXPECT_TRUE(only_their_sum_is_known(1, 1, -0.99, 0.5));
  EXPECT_FALSE(only_their_sum_is_known(1, 1, -0.8, 0.5));
  EXPECT_FALSE(only_their_sum_is_known(1, 1, -0.99, 5)) << "each is known well enough";
  EXPECT_FALSE(only_their_sum_is_known(1, 100, -9.9, 0.5)) << "one of them is known better than the sum";
  const double unknown = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(only_their_sum_is_known(unknown, unknown, 0, 0.5));
}

TEST(LightIntervals, LightsSideBySideAreNotToldApart) {
  LightEstimates lights = known_lights(2);
  const DirectProblem apart(lights);
  EXPECT_TRUE(light_intervals(apart.response(), with_noise(apart.observations(), 0.01, 1), lights).confounded.empty());
  lights.push_back(lights[1]);
  lights[2].position += Vector3d(0.004, 0.003, 0);
  lights[1].intensity /= 2, lights[2].intensity /= 2;
  const DirectProblem together(lights);
  const auto pairs =
      light_intervals(together.response(), with_noise(together.observations(), 0.01, 1), lights).confounded;
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0], (std::pair<std::size_t, std::size_t>{1, 2}));
}

// What hardly shines at all in a channel, one way or the other, says nothing about the lights.
TEST(LightIntervals, LightsOfDifferentColoursAreToldApart) {
  LightEstimates lights = known_lights(2);
  lights[1].position = lights[0].position + Vector3d(0.3, 0.1, 0);
  lights[0].intensity = {3, 1e-9, 1e-9};
  lights[1].intensity = {1e-9, 1e-9, 1};
  const DirectProblem problem(lights);
  EXPECT_TRUE(
      light_intervals(problem.response(), with_noise(problem.observations(), 0.01, 1), lights).confounded.empty());
}

}  // namespace
}  // namespace chiaro::inverse
