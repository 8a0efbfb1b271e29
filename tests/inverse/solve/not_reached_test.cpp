#include "inverse/solve/not_reached.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using tests::known_lights;
using tests::PaintedCorner;

TEST(NotReached, NamesThePlaceThatIsTooDark) {
  const PaintedCorner corner;
  Target target = corner.target(known_lights(2), 0);
  const std::vector<Vec3f> illumination = target.illumination;
  EXPECT_TRUE(places_not_reached(target, illumination, 0).empty());
  const Receivers& receivers = corner.receivers();
  const Vec3f middle = receivers.positions[receivers.parts[1].first_receiver + receivers.parts[1].receiver_count / 2];
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    if (length(receivers.positions[i] - middle) < 0.3F) target.illumination[i] = {9, 9, 9};
  }
  const std::vector<NotReached> places = places_not_reached(target, illumination, 0.01);
  ASSERT_FALSE(places.empty());
  EXPECT_LT(length(places[0].position - middle), 0.5F);
  EXPECT_LT(places[0].excess, 0);
  double share = 0;
  for (const NotReached& place : places) share += place.share;
  EXPECT_GT(share, 0.5);
  EXPECT_LE(share, 1 + 1e-9);
}

// The rest of the room is so bright that all of the patch is little of its light.
TEST(NotReached, NamesAShadowThatNothingCasts) {
  const PaintedCorner corner(0.1F);
  Target target = corner.target(known_lights(2), 0);
  std::vector<Vec3f> illumination = target.illumination;
  const Receivers& receivers = corner.receivers();
  const Vec3f middle = receivers.positions[receivers.parts[0].first_receiver + receivers.parts[0].receiver_count / 2];
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    if (length(receivers.positions[i] - middle) < 0.25F) target.illumination[i] = 0.1F * target.illumination[i];
  }
  ASSERT_LT(relative_l2(illumination, target.illumination, target.weight), 0.1);
  const std::vector<NotReached> places = places_not_reached(target, illumination, 0.1);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_LT(length(places[0].position - middle), 0.25F);
  EXPECT_GT(places[0].excess, 0);
  EXPECT_EQ(places[0].node, receivers.parts[0].name);
}

// However bright what weighs nothing is.
TEST(NotReached, WhatWeighsNothingHidesNoPlace) {
  const PaintedCorner corner(0.1F);
  Target target = corner.target(known_lights(2), 0);
  const std::vector<Vec3f> illumination = target.illumination;
  const Receivers::Part& painted = corner.receivers().parts[0];
  const auto is_painted = [&](std::size_t i) {
    return i >= painted.first_receiver && i < painted.first_receiver + painted.receiver_count;
  };
  const Vec3f middle = corner.receivers().positions[painted.first_receiver + painted.receiver_count / 2];
  for (std::size_t i = 0; i < target.weight.size(); ++i) {
    if (length(corner.receivers().positions[i] - middle) < 0.25F) target.illumination[i] = 0.1F * illumination[i];
    if (!is_painted(i)) target.weight[i] = 0;
  }
  const std::size_t places = places_not_reached(target, illumination, 0.3).size();
  ASSERT_EQ(places, 1U);
  for (std::size_t i = 0; i < target.weight.size(); ++i) {
    if (!is_painted(i)) target.illumination[i] = {1e5F, 1e5F, 1e5F};
  }
  EXPECT_EQ(places_not_reached(target, illumination, 0.3).size(), places);
}

TEST(NotReached, SaysWhereTheColourAloneDiffers) {
  const PaintedCorner corner;
  Target target = corner.target(known_lights(1), 0);
  std::vector<Vec3f> found = target.illumination;
  for (Vec3f& value : found) value = luminance(value) * Vec3f{2, 0.75F, 0.55F};
  for (Vec3f& value : target.illumination) value = luminance(value) * Vec3f{1, 1, 1};
  const std::vector<NotReached> places = places_not_reached(target, found, 0);
  ASSERT_FALSE(places.empty());
  for (const NotReached& place : places) EXPECT_TRUE(place.other_color) << place.node;
  for (Vec3f& value : found) value = 0.5F * luminance(value) * Vec3f{1, 1, 1};
  for (const NotReached& place : places_not_reached(target, found, 0)) EXPECT_FALSE(place.other_color) << place.node;
}

TEST(NotReached, NoiseIsNoPlace) {
  const PaintedCorner corner;
  const Target target = corner.target(known_lights(2), 0);
  std::vector<Vec3f> noisy = target.illumination;
  for (std::size_t i = 0; i < noisy.size(); ++i) noisy[i] = (i % 2 == 0 ? 1.08F : 0.92F) * noisy[i];
  EXPECT_TRUE(places_not_reached(target, noisy, 0.08).empty());
  EXPECT_FALSE(places_not_reached(target, noisy, 0.01).empty());
}

// Where users have lights in a plane, or in two boxes side by side, they are not at a border for that.
TEST(NotReached, LightsAtNoBorderKeepTheirIntervals) {
  const PaintedCorner corner;
  const Target target = corner.target(known_lights(1), 0);
  SolveProblem problem{corner.tracer(), target, {}, {}, tests::bake_settings(0), {}};
  SolveResult result;
  result.not_reached.resize(1);
  result.lights.push_back({renderer::PointLight{"", {2, 2, 2}, {1, 1, 1}}, 1, {0.1F, 0.1F, 0.1F}, {0.1F, 0.1F, 0.1F}});
  const auto knows = [&](std::vector<renderer::Box3f> boxes) {
    problem.places.boxes = std::move(boxes);
    SolveResult left = result;
    leave_unknown_at_border(problem, left);
    return is_finite(left.lights[0].position_interval);
  };
  EXPECT_TRUE(knows({{{1, 1, 1}, {3, 3, 3}}}));
  EXPECT_TRUE(knows({{{1, 2, 1}, {3, 2, 3}}}));
  EXPECT_TRUE(knows({{{1, 1, 1}, {2, 3, 3}}, {{1.5F, 1, 1}, {3, 3, 3}}}));
  EXPECT_FALSE(knows({{{2, 1, 1}, {3, 3, 3}}}));
  EXPECT_FALSE(knows({{{1, 2, 2}, {3, 2, 3}}}));
}

TEST(NotReached, IntervalsLargerThanTheRegionAreUnknown) {
  SolveResult result;
  result.region = {{0, 0, 0}, {1, 2, 2}};
  result.lights.push_back({renderer::PointLight{"", {}, {1, 1, 1}}, 1, {0.1F, 3.1F, 2.9F}, {7, 8, 9}});
  leave_unknown_beyond_region(result);
  EXPECT_EQ(result.lights[0].position_interval, (Vec3f{0.1F, renderer::kInfinity, 2.9F}));
  EXPECT_EQ(result.lights[0].intensity_interval, (Vec3f{7, 8, 9}));
}

// A bright patch on a wall and nothing else, and lights that may stand on the other side of the room alone.
TEST(NotReached, SolvesSayWhatMayHelp) {
  const PaintedCorner corner;
  const Target target = corner.target(known_lights(3), 0);
  SolveProblem problem{corner.tracer(), target, {}, {}, tests::bake_settings(0), {}};
  problem.grid.counts = {7, 6, 7};
  SolveOptions options;
  options.important_vertices = 200;
  options.verification_samples = 16;
  options.max_lights = 2;
  const SolveResult few = solve(problem, options);
  EXPECT_FALSE(few.not_reached.empty());
  EXPECT_NE(few.advice.find("more lights"), std::string::npos) << few.advice;
  options.max_lights = 1;
  const SolveResult one = solve(problem, options);
  EXPECT_EQ(one.advice, "more lights may come closer: 1 was allowed");
  EXPECT_EQ(one.termination, Termination::kAsManyAsAllowed);
  options.time_limit = 1e-9;
  EXPECT_NE(solve(problem, options).advice.find("time limit"), std::string::npos);
  options.time_limit = 0;
  options.max_lights = 8;
  const SolveResult enough = solve(problem, options);
  EXPECT_TRUE(enough.not_reached.empty());
  EXPECT_TRUE(enough.advice.empty());
  problem.places.boxes = {{{1.5F, 2.5F, 1.5F}, {2, 2.8F, 2}}};
  options.max_lights = 1;
  const std::string both = solve(problem, options).advice;
  EXPECT_NE(both.find("more lights"), std::string::npos) << both;
  EXPECT_NE(both.find("a larger one may help"), std::string::npos) << both;
  options.max_lights = 8;
  const SolveResult narrow = solve(problem, options);
  EXPECT_FALSE(narrow.not_reached.empty());
  EXPECT_NE(narrow.advice.find("region"), std::string::npos) << narrow.advice;
}

}  // namespace
}  // namespace chiaro::inverse
