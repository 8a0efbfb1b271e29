#include "inverse/solve/missed_lights.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

// Receivers that get direct light of three lights, known to a twentieth of the mean; the shadows of some are elsewhere.
class MissedLights : public ::testing::Test {
 protected:
  static constexpr int kReceivers = 1800;

  MissedLights() {
    Observations& observations = bench_.observations;
    const double noise = 0.05 * observations.wanted.mean();
    observations.wanted += noise_up_to(noise, kReceivers);
    for (Eigen::Index i = 0; i < kReceivers; i += 60) {
      observations.wanted.row(i).setConstant(i % 120 == 0 ? 0 : 3 * observations.wanted.mean());
    }
    observations.standard_error.setConstant(noise / std::sqrt(3));
    observations.sqrt_weight.setConstant(1 / noise);
    observations.measure_target();
  }

  LightEstimates missed_beside(const LightEstimates& lights, std::size_t most) const {
    const std::vector<Column> indirect(lights.size(), Column::Zero(kReceivers, 3));
    return find_missed_lights(bench_, indirect, lights, problem_.response().places_near_grid_lights(), most);
  }

  const LightEstimates known_ = known_lights(3);
  const DirectProblem problem_{known_, kReceivers};
  SettlingBench bench_{problem_.response(), problem_.observations()};
};

TEST_F(MissedLights, AreFoundThoughOneHidesTheOther) {
  LightEstimates lights = missed_beside({known_[0]}, 5);
  EXPECT_EQ(lights.size(), 2U);
  lights.push_back(known_[0]);
  EXPECT_LT(farthest_from(known_, positions_of(lights)), 0.15);  // of 6.4 m: settling does the rest
}

TEST_F(MissedLights, AreNoMoreThanMayBe) { EXPECT_EQ(missed_beside({known_[0]}, 1).size(), 1U); }

TEST_F(MissedLights, AreNoneBesideThoseThatExplainAll) { EXPECT_TRUE(missed_beside(known_, 5).empty()); }

}  // namespace
}  // namespace chiaro::inverse
