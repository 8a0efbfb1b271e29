#include "inverse/target/target_from_values.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "inverse/target/receiver_lookup.h"

namespace chiaro::inverse {
namespace {

constexpr int kSide = 5;  // vertices along a side of 4 m

// A board in the xz plane: the upper side's receivers first, then the lower side's, 1 cm below.
Receivers board() {
  Receivers receivers;
  for (const float y : {0.0F, -0.01F}) {
    const auto first = std::uint32_t(receivers.size());
    for (int z = 0; z < kSide; ++z) {
      for (int x = 0; x < kSide; ++x) {
        receivers.positions.push_back({float(x), y, float(z)});
        receivers.normals.push_back({0, y < 0 ? -1.0F : 1.0F, 0});
      }
    }
    for (std::uint32_t z = 0; z + 1 < kSide; ++z) {
      for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
        const std::uint32_t a = first + z * kSide + x;
        receivers.triangles.push_back({a, a + kSide, a + 1});
        receivers.triangles.push_back({a + 1, a + kSide, a + kSide + 1});
      }
    }
  }
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    receivers.samples.push_back({receivers.positions[i], receivers.normals[i]});
  }
  return receivers;
}

constexpr std::size_t kUpper = kSide * kSide;

Vec3f linear_field(Vec3f p) { return {1 + p.x, 2 + 0.5F * p.z, 7}; }

std::vector<SurfaceValue> dense_values(int per_side, Vec3f normal = {0, 1, 0}) {
  std::vector<SurfaceValue> values;
  for (int z = 0; z < per_side; ++z) {
    for (int x = 0; x < per_side; ++x) {
      const Vec3f p{(float(x) + 0.5F) * 4 / float(per_side), 0, (float(z) + 0.5F) * 4 / float(per_side)};
      values.push_back({p, normal, linear_field(p), 1});
    }
  }
  return values;
}

TEST(ReceiverLookup, GivesBarycentricCoordinatesOnTheSideThatIsSeen) {
  const Receivers receivers = board();
  const ReceiverLookup lookup(receivers);
  for (const Vec3f normal : {Vec3f{0, 1, 0}, Vec3f{0, -1, 0}}) {
    const auto found = lookup.find({1.25F, normal.y < 0 ? -0.01F : 0, 2.5F}, normal);
    ASSERT_TRUE(found);
    Vec3f p;
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(receivers.normals[found->receivers[k]], normal);
      p += found->weights[k] * receivers.positions[found->receivers[k]];
    }
    EXPECT_NEAR(p.x, 1.25F, 1e-5F);
    EXPECT_NEAR(p.z, 2.5F, 1e-5F);
  }
}

TEST(ReceiverLookup, FindsNothingOffTheSurfaceOrAcrossIt) {
  const Receivers receivers = board();
  const ReceiverLookup lookup(receivers);
  EXPECT_FALSE(lookup.find({1, 0.5F, 1}, {0, 1, 0}));
  EXPECT_FALSE(lookup.find({1, 0, 1}, {1, 0, 0}));
  EXPECT_FALSE(ReceiverLookup(Receivers{}).find({0, 0, 0}, {0, 1, 0}));
}

TEST(ReceiverLookup, WithoutTrianglesTakesTheNearestReceiver) {
  Receivers points = board();
  points.triangles.clear();
  const auto found = ReceiverLookup(points).find({2.1F, 0, 3.05F}, {0, 1, 0});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->receivers[0], std::uint32_t(3 * kSide + 2));
}

TEST(TargetFromValues, BringsALinearFieldToItsReceivers) {
  const Receivers receivers = board();
  const TargetFromValues result = target_from_values(receivers, dense_values(40));
  EXPECT_EQ(result.not_placed, 0U);
  for (std::size_t i = 0; i < kUpper; ++i) {
    const Vec3f expected = linear_field(result.target.receivers.samples[i].position);
    // The mean that each is drawn to by a tenth lies up to a third of an edge inside the border.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.target.illumination[i][c], expected[c], 0.08F) << i;
  }
  EXPECT_NEAR(result.target.illumination[12][0], 3, 0.06F);
}

// The value of a receiver is that of the place where its sample lies, also where values cover a part of its triangles.
TEST(TargetFromValues, SamplesReceiversWhereTheValuesAre) {
  std::vector<SurfaceValue> values = dense_values(40);
  std::erase_if(values, [](const SurfaceValue& value) { return value.position.x > 2.5F; });
  const Receivers receivers = board();
  const Target target = target_from_values(receivers, values).target;
  for (std::size_t i = 0; i < kUpper; ++i) {
    if (target.weight[i] == 0) continue;
    const Vec3f at = target.receivers.samples[i].position, expected = linear_field(at);
    EXPECT_LT(at.x, 2.55F);
    EXPECT_NEAR(at.y, 0, 1e-4F);
    EXPECT_GT(at.y, 0);
    EXPECT_EQ(target.receivers.samples[i].normal, (Vec3f{0, 1, 0}));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(target.illumination[i][c], expected[c], 0.1F) << i;
  }
  EXPECT_GT(target.weight[13], 0);  // at x = 3, beyond them
  EXPECT_EQ(target.weight[14], 0);
}

TEST(TargetFromValues, WeighsByWhatFallsToAReceiver) {
  const TargetFromValues result = target_from_values(board(), dense_values(40));
  const std::vector<float>& weight = result.target.weight;
  double sum = 0;
  for (std::size_t i = 0; i < kUpper; ++i) sum += weight[i];
  EXPECT_NEAR(sum / double(kUpper), 1, 1e-5);
  EXPECT_NEAR(weight[12] / weight[2], 2, 0.02);  // a receiver inside and one on the border
  for (std::size_t i = kUpper; i < weight.size(); ++i) EXPECT_EQ(weight[i], 0) << "the lower side is not seen";
}

TEST(TargetFromValues, LeavesOutValuesWithoutWeightOrReceivers) {
  std::vector<SurfaceValue> values = dense_values(20);
  for (SurfaceValue& value : values) value.illumination = {2, 2, 2};
  values.push_back({{1, 0, 1}, {0, 1, 0}, {1000, 1000, 1000}, 0});
  values.push_back({{1, 2, 1}, {0, 1, 0}, {1000, 1000, 1000}, 1});
  const TargetFromValues result = target_from_values(board(), values);
  EXPECT_EQ(result.not_placed, 1U);
  for (std::size_t i = 0; i < kUpper; ++i) EXPECT_NEAR(result.target.illumination[i][1], 2, 1e-5F);
}

// Errors of 400 receivers against their estimate, which is one for all shapes of triangles: by a third more or less.
TEST(TargetFromValues, EstimatesItsStandardErrorFromTheScatter) {
  const Receivers receivers = board();
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.5F);
  double squares = 0;
  int count = 0;
  for (int run = 0; run < 16; ++run) {
    std::vector<SurfaceValue> values = dense_values(60);
    for (SurfaceValue& value : values)
      value.illumination = Vec3f{9, 9, 9} + Vec3f{noise(random), noise(random), noise(random)};
    const Target target = target_from_values(receivers, values).target;
    for (std::size_t i = 0; i < kUpper; ++i) {
      const Vec3f off = target.illumination[i] - Vec3f{9, 9, 9};
      squares += length_squared(off) / 3 / (target.standard_error[i] * target.standard_error[i]);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.33);
}

TEST(TargetFromValues, OfNoValuesWeighsNothing) {
  const Target target = target_from_values(board(), {}).target;
  for (std::size_t i = 0; i < target.weight.size(); ++i) {
    EXPECT_EQ(target.weight[i], 0);
    EXPECT_EQ(target.illumination[i], Vec3f{});
  }
}

TEST(CombineTargets, WeighsTheirValues) {
  Target a = target_from_values(board(), {}).target, b = a;
  a.illumination[0] = {1, 1, 1}, a.weight[0] = 1, a.standard_error[0] = 0.3F;
  b.illumination[0] = {5, 5, 5}, b.weight[0] = 3, b.standard_error[0] = 0.4F;
  a.receivers.samples_moved = false, b.receivers.samples_moved = true;
  const Target sum = combine(a, b);
  EXPECT_TRUE(sum.receivers.samples_moved);
  EXPECT_FLOAT_EQ(sum.illumination[0].x, 4);
  EXPECT_FLOAT_EQ(sum.weight[0], 4);
  EXPECT_FLOAT_EQ(sum.standard_error[0], std::hypot(0.25F * 0.3F, 0.75F * 0.4F));
  EXPECT_EQ(sum.weight[1], 0);
}

}  // namespace
}  // namespace chiaro::inverse
