#include "inverse/solve/refine_over_many.h"

#include <gtest/gtest.h>

#include "inverse/solve/directly_lit.h"
#include "inverse/solve/observe_target.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using tests::bake_settings;
using tests::farthest_from;
using tests::known_lights;
using tests::PaintedCorner;
using tests::positions_of;

constexpr std::size_t kAll = 1000000;

LightEstimates displaced(LightEstimates lights, double metres, double brighter) {
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const double side = j % 2 == 0 ? 1 : -1;
    lights[j].position += side * metres * Eigen::Vector3d(0.6, -0.64, 0.48);
    lights[j].intensity *= 1 + side * brighter;
  }
  return lights;
}

class RefineOverMany : public ::testing::Test {
 protected:
  explicit RefineOverMany(renderer::Scene scene = test::corner_with_ball()) : corner_(0.2F, std::move(scene)) {}

  LightEstimates refine(const LightEstimates& known, int bounces, const LightEstimates& start,
                        const LightEstimates& others = {}) const {
    const Target target = corner_.target(known, bounces);
    const ReceiverDraw draw = draw_evenly(target, kAll);
    TransportCache nothing;
    nothing.grid = make_light_grid(corner_.tracer(), {});
    const LightResponse anywhere(corner_.tracer(), {}, nothing);
    const DirectlyLit many(corner_.tracer(), anywhere, target.receivers.samples);
    const Observations observations = observe_target(target, draw, std::vector<Vec3f>(draw.chosen.size()));
    BakeSettings settings = bake_settings(bounces);
    settings.samples = 512;  // tells of biases that fewer paths hide
    settings.seed = 5;
    return refine_over_many({corner_.tracer(), many.response(), observations, settings, {}}, start, others).lights;
  }

  void expect_near(const LightEstimates& found, const LightEstimates& known, double metres, double intensity) const {
    ASSERT_EQ(found.size(), known.size());
    EXPECT_LT(farthest_from(known, positions_of(found)), metres);
    for (std::size_t j = 0; j < known.size(); ++j) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[j].intensity[c] / known[j].intensity[c], 1, intensity) << j;
    }
  }

  PaintedCorner corner_;
};

TEST_F(RefineOverMany, FindsWhatMadeADirectTargetAlmostExactly) {
  const LightEstimates known = known_lights(3);
  expect_near(refine(known, 0, displaced(known, 0.05, 0.1)), known, 1e-4, 1e-4);
}

// The target has a noise of some percent, and so has the indirect light that is traced here: neither dims the lights.
TEST_F(RefineOverMany, IsNotLedAsideByNoiseNorByShadowEdges) {
  const LightEstimates known = known_lights(3);
  expect_near(refine(known, -1, displaced(known, 0.05, 0.1)), known, 0.005, 0.01);
}

TEST_F(RefineOverMany, LeavesOthersAlone) {
  const LightEstimates known = known_lights(2);
  const LightEstimates one{known[0]}, other{known[1]};
  expect_near(refine(known, -1, displaced(one, 0.05, 0.1), other), one, 0.005, 0.01);
}

// A closed room of white walls, where three quarters of the light have been reflected before.
class RefineOverManyInAWhiteRoom : public RefineOverMany {
 protected:
  RefineOverManyInAWhiteRoom() : RefineOverMany(white_room()) {}

  static renderer::Scene white_room() {
    renderer::Scene scene;
    test::add_mesh(scene, test::room({4, 3, 4}), test::lambert({0.75F, 0.75F, 0.75F}), "room");
    return scene;
  }
};

TEST_F(RefineOverManyInAWhiteRoom, FollowsLightByBouncesWithTheIntensities) {
  const LightEstimates known = known_lights(1);
  expect_near(refine(known, -1, displaced(known, 0.05, 0.3)), known, 0.005, 0.01);
}

TEST_F(RefineOverMany, OfNoLightsIsNone) { EXPECT_TRUE(refine(known_lights(1), 0, {}).empty()); }

TEST(DrawEvenly, TakesReceiversOfPositiveWeightAtEvenSteps) {
  Target target;
  target.receivers.samples.resize(100);
  target.receivers.positions.resize(100);
  target.weight.assign(100, 1.0F);
  for (int i = 0; i < 20; ++i) target.weight[std::size_t(i)] = 0;
  const ReceiverDraw some = draw_evenly(target, 40);
  ASSERT_EQ(some.chosen.size(), 40U);
  for (std::size_t k = 0; k < 40; ++k) EXPECT_EQ(some.chosen[k], 20 + 2 * k);
  EXPECT_EQ(some.probability, std::vector<double>(40, 0.5));
  EXPECT_EQ(draw_evenly(target, 1000).chosen.size(), 80U);
}

}  // namespace
}  // namespace chiaro::inverse
