#include "inverse/solve/polish_lights.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

constexpr double kNoise = 0.01;  // of the target

// Two lights, of which sets of 1, 2, … lights were found by a search.
class PolishedCorner : public ::testing::Test {
 protected:
  const LightEstimates known_ = known_lights(2);
  DirectProblem problem_{known_};
  const LightEstimates one_{{{2, 2, 2}, {1, 1, 1}}};
  // Two of them are inside the ball, where no step brightens anything.
  const LightEstimates three_{one_[0], {{2.2, 0.6, 1.8}, {1, 1, 1}}, {{2.1, 0.7, 1.8}, {1, 1, 1}}};

  PolishedLights polished(const std::vector<LightEstimates>& sets, double noise = kNoise) const {
    Observations observations = problem_.observations();
    observations.noise = noise;
    return polish_fewest(problem_.exact(), problem_.response(), observations, sets, StageClock());
  }
  double farthest(const PolishedLights& found) const { return farthest_from(known_, positions_of(found.lights)); }

  LightEstimates nearby() const {
    LightEstimates lights = known_;
    for (LightEstimate& light : lights) light.position += 0.02 * problem_.diagonal() * Vector3d::UnitY();
    return lights;
  }
};

TEST_F(PolishedCorner, ComesToWhereLightsAre) {
  const PolishedLights found = polished({one_, nearby()});
  EXPECT_EQ(found.started_with, 2U);
  EXPECT_LT(farthest(found), 1e-3 * problem_.diagonal());
  EXPECT_LT(found.error, kNoise);
}

TEST_F(PolishedCorner, TakesFewerWhereTheyLeaveLess) {
  const PolishedLights found = polished({one_, nearby(), three_});
  EXPECT_EQ(found.started_with, 2U);
  ASSERT_EQ(found.lights.size(), 2U);
  EXPECT_LT(farthest(found), 1e-3 * problem_.diagonal());
}

TEST_F(PolishedCorner, KeepsMoreThatLeaveLittleButNoise) {
  const double noise = polished({{}, {}, three_}).error;
  EXPECT_EQ(polished({one_, nearby(), three_}, noise).started_with, 3U);
}

TEST_F(PolishedCorner, TakesNoFewerWhereNoneWereFound) {
  const PolishedLights found = polished({one_, {}, three_});
  EXPECT_EQ(found.started_with, 3U);
  EXPECT_GT(found.error, kNoise);
}

}  // namespace
}  // namespace chiaro::inverse
