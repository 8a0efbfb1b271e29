#include "inverse/target/compare_targets.h"

#include <cmath>

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "tests/inverse/target/surfaces.h"

namespace chiaro::inverse {
namespace {

using tests::make_floor;
using tests::make_sheet;
using tests::make_target;

// Two by two receivers.
Receivers four() { return make_sheet({}, {0, 0, 1}, {1, 0, 0}, 2); }

TEST(RelativeL2, IsTheClosedFormWithWeights) {
  const std::vector<Vec3f> a{{3, 0, 0}, {1, 1, 1}}, b{{0, 4, 0}, {1, 1, 1}};
  EXPECT_DOUBLE_EQ(relative_l2(a, b, {1, 1}), std::sqrt(25.0 / 19.0));
  EXPECT_DOUBLE_EQ(relative_l2(a, b, {2, 1}), std::sqrt(50.0 / 35.0));
  EXPECT_DOUBLE_EQ(relative_l2(a, b, {0, 1}), 0);
}

TEST(RelativeL2, ScalesWithTheDifference) {
  const std::vector<Vec3f> b{{1, 2, 3}, {0, 5, 0.5F}};
  const std::vector<Vec3f> a{1.25F * b[0], 1.25F * b[1]};
  EXPECT_NEAR(relative_l2(a, b, {0.3F, 7}), 0.25, 1e-12);
}

TEST(RelativeL2, OfABlackReferenceIsZeroOrInfinite) {
  EXPECT_EQ(relative_l2({{}}, {{}}, {1}), 0);
  EXPECT_TRUE(std::isinf(relative_l2({{1, 0, 0}}, {{}}, {1})));
}

TEST(CompareTargets, FiguresAreTheHandComputedOnes) {
  Target a = make_target(four(), {1, 1, 1}), b = a;
  a.illumination[2] = {1, 3, 1};
  a.illumination[3] = {1, 1, 0};
  const TargetComparison found = compare_targets(a, b);
  EXPECT_DOUBLE_EQ(found.relative_l2, std::sqrt(5.0 / 12.0));
  EXPECT_DOUBLE_EQ(found.rmse, std::sqrt(5.0 / 12.0));
  EXPECT_DOUBLE_EQ(found.relative_mse, 5.0 / 1.0001 / 12.0);
  EXPECT_NEAR(found.psnr, 10 * std::log10(12.0 / 5.0), 1e-12);
  EXPECT_EQ(found.max_difference, 2);
  EXPECT_EQ(found.max_at, 2U);
  EXPECT_EQ(found.mean_a, (Vec3f{1, 1.5F, 0.75F}));
  EXPECT_EQ(found.mean_b, (Vec3f{1, 1, 1}));
}

TEST(CompareTargets, ReceiversCountAsTheReferenceWeighsThem) {
  Target a = make_target(four(), {1, 1, 1}), b = a;
  a.illumination[0] = {9, 9, 9};
  a.illumination[1] = {2, 1, 1};
  a.weight = {1, 0, 0, 0};
  b.weight = {0, 3, 1, 2};
  const TargetComparison found = compare_targets(a, b);
  EXPECT_DOUBLE_EQ(found.relative_l2, std::sqrt(3.0 / 18.0));
  EXPECT_DOUBLE_EQ(found.rmse, std::sqrt(3.0 / 18.0));
  EXPECT_EQ(found.max_difference, 1);
  EXPECT_EQ(found.max_at, 1U);
  EXPECT_EQ(found.mean_a, (Vec3f{1.5F, 1, 1}));
}

TEST(CompareTargets, ChannelsAndSurfacesHaveFiguresOfTheirOwn) {
  Target a = make_target(four(), {1, 1, 1});
  a.receivers.parts = {{"near", 0, 2, 0, 0}, {"far", 2, 2, 0, 0}};
  Target b = a;
  a.illumination[0] = {3, 1, 1};
  a.illumination[3] = {1, 1, 2};
  b.weight = {1, 1, 0, 0};
  const TargetComparison found = compare_targets(a, b);
  EXPECT_DOUBLE_EQ(found.channels[0].relative_l2, std::sqrt(4.0 / 2.0));
  EXPECT_DOUBLE_EQ(found.channels[0].mean_a, 2);
  EXPECT_EQ(found.channels[1].rmse, 0);
  EXPECT_EQ(found.channels[2].max_difference, 0);
  ASSERT_EQ(found.surfaces.size(), 1U) << "of the other nothing is wanted";
  EXPECT_EQ(found.surfaces[0].name, "near");
  EXPECT_DOUBLE_EQ(found.surfaces[0].relative_l2, std::sqrt(4.0 / 6.0));
  EXPECT_EQ(found.surfaces[0].mean_a, (Vec3f{2, 1, 1}));
  EXPECT_EQ(found.surfaces[0].max_difference, 2);
}

TEST(CompareTargets, EqualTargetsDifferByNothing) {
  const Target target = make_target(four(), {0.1F, 2, 3});
  const TargetComparison found = compare_targets(target, target);
  EXPECT_EQ(found.relative_l2, 0);
  EXPECT_EQ(found.rmse, 0);
  EXPECT_EQ(found.max_difference, 0);
  EXPECT_TRUE(std::isinf(found.psnr) && found.psnr > 0);
}

TEST(CompareTargets, OtherReceiversAreAnError) {
  const Target a = make_target(make_floor(), {1, 1, 1});
  EXPECT_THROW(compare_targets(a, make_target(four(), {1, 1, 1})), renderer::Error);
  EXPECT_THROW(compare_targets(a, make_target(make_floor(0.01F), {1, 1, 1})), renderer::Error);
  EXPECT_NO_THROW(compare_targets(a, make_target(make_floor(1e-6F), {1, 1, 1})));
}

TEST(CompareTargets, AReferenceWithoutWeightIsAnError) {
  const Target a = make_target(four(), {1, 1, 1});
  EXPECT_THROW(compare_targets(a, make_target(four(), {1, 1, 1}, 0)), renderer::Error);
}

}  // namespace
}  // namespace chiaro::inverse
