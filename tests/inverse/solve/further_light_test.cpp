#include "inverse/solve/further_light.h"

#include <gtest/gtest.h>

#include "inverse/solve/refine_joint.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

// Receivers that get direct light of known lights, each with noise of a twentieth of the mean.
class FurtherLight : public ::testing::Test {
 protected:
  static constexpr int kReceivers = 1800;

  explicit FurtherLight(LightEstimates known = known_lights(3)) : known_(std::move(known)) {
    bench_.observations.wanted += noise_up_to(0.05 * bench_.observations.wanted.mean(), kReceivers);
  }

  // Descended from here, and one light more.
  std::optional<LightEstimates> beside(const LightEstimates& start, const FurtherLights& further) const {
    const LightEstimates lights = refine_joint(bench_.response, bench_.observations, start).lights;
    const std::vector<Column> indirect(lights.size(), Column::Zero(kReceivers, 3));
    return with_further_light(problem_.tracer(), bench_, indirect, lights, further, 2);
  }
  FurtherLights anywhere() const { return {problem_.response().places_near_grid_lights(), {}}; }

  const LightEstimates known_;
  const DirectProblem problem_{known_, kReceivers};
  SettlingBench bench_{problem_.response(), problem_.observations()};
};

class FurtherLightOfAPair : public FurtherLight {
 protected:
  FurtherLightOfAPair()
      : FurtherLight({{{3.3, 2.4, 0.6}, {9, 9, 9}}, {{1.6, 2.4, 1.5}, {12, 4, 3}}, {{2.2, 1.9, 2.3}, {3, 6, 12}}}) {}
};

TEST_F(FurtherLight, ThatWasMissedIsFound) {
  const auto found = beside({known_[0], known_[1]}, anywhere());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->size(), 3U);
  EXPECT_LT(farthest_from(known_, positions_of(*found)), 0.02);
}

TEST_F(FurtherLight, IsNotAddedToThoseThatExplainAll) { EXPECT_FALSE(beside(known_, anywhere())); }

TEST_F(FurtherLightOfAPair, PartsWhatStoodForBoth) {
  const LightEstimate both{(known_[1].position + known_[2].position) / 2, Array3d::Constant(10)};
  const auto found = beside({known_[0], both}, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->size(), 3U);
  EXPECT_LT(farthest_from(known_, positions_of(*found)), 0.02);
}

}  // namespace
}  // namespace chiaro::inverse
