// A file that Blender 3.4 painted and exported (blender/make_painted.py says how).

#include <gtest/gtest.h>

#include "inverse/target/target.h"

namespace chiaro::inverse {
namespace {

constexpr float kScale = 40;

Vec3f painted_at(Vec3f p, float gain) { return (kScale / 4) * Vec3f{gain * (p.x + 2), p.y + 2, p.z + 2}; }

Target blender_target() { return load_target(CHIARO_SOURCE_DIR "/tests/inverse/target/blender/painted.glb", kScale); }

void expect_part(const Target& target, std::size_t part, float tolerance, const auto& wanted) {
  const Receivers::Part& range = target.receivers.parts.at(part);
  for (std::size_t i = range.first_receiver; i < range.first_receiver + range.receiver_count; ++i) {
    const Vec3f expected = wanted(target.receivers.positions[i]);
    EXPECT_EQ(target.weight[i], 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(target.illumination[i][c], expected[c], tolerance * kScale) << i;
  }
}

TEST(BlenderTarget, FloatColoursGoBeyondOne) {
  const Target target = blender_target();
  EXPECT_EQ(target.receivers.parts.at(0).name, "floats");
  expect_part(target, 0, 1e-6F, [](Vec3f p) { return painted_at(p, 3); });
}

// They are bytes on the sRGB curve in Blender: steps of 1.5 % near 0.7, half of that to either side.
TEST(BlenderTarget, ByteColoursAreLinear) {
  const Target target = blender_target();
  EXPECT_EQ(target.receivers.parts.at(1).name, "bytes");
  EXPECT_GT(target.receivers.parts[1].receiver_count, 26U) << "split at its edges";
  expect_part(target, 1, 0.005F, [](Vec3f p) { return painted_at(p, 1); });
}

TEST(BlenderTarget, CopiesArePaintedAlike) {
  const Target target = blender_target();
  EXPECT_EQ(target.receivers.parts.at(2).name, "copy");
  expect_part(target, 2, 0.005F, [](Vec3f p) { return painted_at({10 - p.x, p.y, p.z}, 1); });
}

TEST(BlenderTarget, WhatIsNotPaintedDoesNotMatter) {
  const Target target = blender_target();
  const Receivers::Part& range = target.receivers.parts.at(3);
  EXPECT_EQ(range.name, "unpainted");
  for (std::size_t i = range.first_receiver; i < target.weight.size(); ++i) EXPECT_EQ(target.weight[i], 0);
}

}  // namespace
}  // namespace chiaro::inverse
