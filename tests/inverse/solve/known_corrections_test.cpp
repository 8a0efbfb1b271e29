#include "inverse/solve/known_corrections.h"

#include <gtest/gtest.h>

#include "inverse/transport/light_grid.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

class CorrectedCorner : public ::testing::Test {
 protected:
  static constexpr std::size_t kReceivers = 60;

  PaintedCorner corner_;
  Receivers some_ = select_receivers(corner_.receivers(), evenly_spread(corner_.receivers().size(), kReceivers));
  TransportCache cache_ =
      bake(corner_.tracer(), some_, make_light_grid(corner_.tracer(), {.counts = {3, 3, 3}, .region = {}}),
           bake_settings(-1))
          .cache;
  LightResponse response_{corner_.tracer(), some_.samples, cache_};
  ExactIndirect exact_{corner_.tracer(), some_.samples, cache_.settings};
  KnownCorrections corrections_{exact_, response_, 5e-4 * corner_.diagonal()};
  const LightEstimates known_ = known_lights(3);
  const Vector3d step_ = 1e-4 * corner_.diagonal() * Vector3d::UnitX();  // indirect light hardly changes

  LightEstimate moved(const LightEstimate& light, const Vector3d& by) const {
    return {light.position + by, light.intensity};
  }
};

TEST_F(CorrectedCorner, AreThoseOfExactIndirectLight) {
  std::vector<LightEstimates> sets{{known_[0], known_[1]}, {known_[2]}};
  EXPECT_FALSE(corrections_.has_all(sets[0]));
  corrections_.correct(sets);
  LightEstimates expected = known_;
  exact_.correct(response_, expected);
  const LightEstimate* const found[] = {&sets[0][0], &sets[0][1], &sets[1][0]};
  for (std::size_t j = 0; j < expected.size(); ++j) {
    ASSERT_GT(expected[j].correction.norm(), 0);
    EXPECT_LT((found[j]->correction - expected[j].correction).norm(), 1e-3 * expected[j].correction.norm());
    EXPECT_EQ(found[j]->corrected_at, known_[j].position);
  }
  EXPECT_TRUE(corrections_.has_all(sets[0]) && corrections_.has_all(sets[1]));
}

TEST_F(CorrectedCorner, ServeLightsInTheSamePlaceAndNoOthers) {
  std::vector<LightEstimates> first{{known_[0]}};
  corrections_.correct(first);
  std::vector<LightEstimates> sets{{moved(known_[0], step_), known_[1]}, {moved(known_[0], 1000 * step_)}};
  corrections_.correct(sets);
  EXPECT_EQ(sets[0][0].corrected_at, known_[0].position);
  EXPECT_EQ(sets[0][0].correction, first[0][0].correction);
  EXPECT_EQ(sets[0][0].position, known_[0].position + step_);
  EXPECT_EQ(sets[0][1].corrected_at, known_[1].position);
  EXPECT_EQ(sets[1][0].corrected_at, known_[0].position + 1000 * step_);
}

TEST_F(CorrectedCorner, GrowOldWhereALightGoesAway) {
  std::vector<LightEstimates> sets{{known_[0]}};
  corrections_.correct(sets);
  sets[0][0].position += step_;
  EXPECT_TRUE(corrections_.has_all(sets[0]));
  sets[0][0].position += 100 * step_;
  EXPECT_FALSE(corrections_.has_all(sets[0]));
  corrections_.correct(sets);
  EXPECT_EQ(sets[0][0].corrected_at, sets[0][0].position);
}

}  // namespace
}  // namespace chiaro::inverse
