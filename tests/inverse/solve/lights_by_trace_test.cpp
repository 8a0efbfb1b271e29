#include "inverse/solve/lights_by_trace.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using tests::bake_settings;
using tests::known_lights;
using tests::PaintedCorner;

class RefitByTrace : public ::testing::Test {
 protected:
  LightsByTrace refit(const Target& target, const LightEstimates& lights, const IntensityRules& rules = {}) const {
    SolveProblem problem{corner_.tracer(), target, {}, {}, bake_settings(-1), {}};
    problem.intensities = rules;
    SolveOptions options;
    options.verification_samples = 256;
    StageClock clock;
    return refit_by_trace(problem, options, {}, lights, clock);
  }

  PaintedCorner corner_;
};

// Two lights at once too bright and too dark; their places are right.
TEST_F(RefitByTrace, GivesTheIntensitiesThatMadeTheTarget) {
  const LightEstimates known = known_lights(2);
  const Target target = corner_.target(known, -1);
  LightEstimates start = known;
  start[0].intensity *= Eigen::Array3d(3, 0.2, 1);
  start[1].intensity *= Eigen::Array3d(0.5, 1, 9);
  const LightsByTrace refitted = refit(target, start);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_EQ(refitted.lights[j].position, known[j].position);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(refitted.lights[j].intensity[c] / known[j].intensity[c], 1, 0.01);
  }
  // The trace is theirs: what is left is noise.
  EXPECT_LT(relative_l2(refitted.traced.all.value, target.illumination, target.weight), 0.03);
}

// Least squares would take the noise of few paths for light of its own, and dim the lights.
TEST_F(RefitByTrace, FewPathsDoNotDimTheLights) {
  const LightEstimates known = known_lights(1);
  const Target target = corner_.target(known, -1);
  SolveProblem problem{corner_.tracer(), target, {}, {}, bake_settings(-1), {}};
  problem.intensities.max_intensity = 100;
  for (const std::uint64_t seed : {1, 2, 3}) {
    SolveOptions options;
    options.seed = seed;
    options.verification_samples = 4;
    StageClock clock;
    const LightEstimate found = refit_by_trace(problem, options, {}, known, clock).lights[0];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.intensity[c] / known[0].intensity[c], 1, 0.03);
  }
}

TEST_F(RefitByTrace, KeepsToTheRules) {
  const LightEstimates known = known_lights(2);
  IntensityRules rules;
  rules.max_intensity = 4;
  LightEstimates start = known;
  for (LightEstimate& light : start) light.intensity = 1;
  for (const LightEstimate& light : refit(corner_.target(known, 0), start, rules).lights) {
    EXPECT_LE(light.intensity.maxCoeff(), 4 * (1 + 1e-12));
    EXPECT_GT(light.intensity.maxCoeff(), 3.9);
  }
}

// What is taken off a channel that goes out is what it gave, but for rounding.
TEST_F(RefitByTrace, LeavesNoNegativeLight) {
  LightEstimates known = known_lights(1);
  known[0].intensity[1] = 0;
  LightEstimates start = known_lights(2);
  start[0].intensity = {3.1, 0.7, 1.3};
  const LightsByTrace refitted = refit(corner_.target(known, -1), start);
  for (const Vec3f& light : refitted.traced.all.value) EXPECT_GE(std::min({light.x, light.y, light.z}), 0);
}

// One that a rule of colors lets shine is traced with the others.
TEST_F(RefitByTrace, ChannelsThatComeOnAreTraced) {
  LightEstimates known = known_lights(2), start = known;
  IntensityRules rules;
  rules.one_color = true;
  for (std::size_t j = 0; j < 2; ++j) start[j].intensity = known[j].intensity = 2 + double(j);
  start[0].intensity[2] = 0;
  const Target target = corner_.target(known, -1);
  const LightsByTrace refitted = refit(target, start, rules);
  ASSERT_GT(refitted.lights[0].intensity[2], 1);
  EXPECT_LT(relative_l2(refitted.traced.all.value, target.illumination, target.weight),
            0.03 + std::abs(refitted.lights[0].intensity[2] / 2 - 1));
}

// Nothing is known of a channel that did not shine.
TEST_F(RefitByTrace, DarkChannelsStayDark) {
  LightEstimates start = known_lights(1);
  start[0].intensity[1] = 0;
  const LightsByTrace refitted = refit(corner_.target(known_lights(1), 0), start);
  EXPECT_EQ(refitted.lights[0].intensity[1], 0);
  for (const Vec3f& light : refitted.traced.all.value) EXPECT_EQ(light.y, 0);
}

TEST(PutOutResidue, TakesWhatRoundingLeftForDarkAndNothingElse) {
  LightEstimates lights{{{0, 0, 0}, {3, 2, 1}}, {{1, 0, 0}, {0, 0, 1e-12}}, {{2, 0, 0}, {1e-6, 0, 0}}};
  put_out_residue(lights);
  EXPECT_TRUE(is_dark(lights[1]));
  EXPECT_FALSE(is_dark(lights[0]) || is_dark(lights[2]));
}

}  // namespace
}  // namespace chiaro::inverse
