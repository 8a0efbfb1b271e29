#include "inverse/target/painted_frame.h"

#include <limits>

#include <gtest/gtest.h>

#include "renderer/trace/camera_rays.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::Material;
using renderer::RayTracer;
using renderer::Scene;
using test::lambert;

constexpr int kWidth = 64, kHeight = 48;

// At (0, 3, 0), looking down; +x to the right, −z up in the picture.
renderer::Camera camera_above() {
  renderer::Camera camera;
  camera.world_from_camera.m = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 3, 0, 1};
  camera.vertical_fov = 0.6F;
  return camera;
}

// A floor of 4 m in two halves.
Scene floor_of(const Material& left, const Material& right) {
  Scene scene;
  test::add_mesh(scene, test::rectangle({-2, 0, 2}, {2, 0, 0}, {0, 0, -4}, 8), left, "left");
  test::add_mesh(scene, test::rectangle({0, 0, 2}, {2, 0, 0}, {0, 0, -4}, 8), right, "right");
  return scene;
}

PaintedFrame frame_of(Vec3f color) {
  PaintedFrame frame{camera_above(), kWidth, kHeight, {}, {}, PictureContent::kBeauty};
  frame.pixels.assign(std::size_t(kWidth) * kHeight, color);
  frame.weight.assign(frame.pixels.size(), 1);
  return frame;
}

std::size_t total(const PixelCounts& c) {
  return c.used + c.masked + c.background + c.edge + c.shiny + c.dark + c.invalid;
}

TEST(PaintedFrame, DividesTheSurfacesColourOut) {
  const Scene scene = floor_of(lambert({0.5F, 0.4F, 0.2F}), lambert({0.5F, 0.4F, 0.2F}));
  const FrameValues read = values_of_frame(RayTracer(scene), frame_of({1, 2, 3}));
  ASSERT_EQ(read.counts.used, std::size_t(kWidth) * kHeight);
  ASSERT_EQ(read.values.size(), read.counts.used);
  for (const SurfaceValue& value : read.values) {
    EXPECT_FLOAT_EQ(value.illumination.x, 2);
    EXPECT_FLOAT_EQ(value.illumination.y, 5);
    EXPECT_FLOAT_EQ(value.illumination.z, 15);
    EXPECT_NEAR(value.position.y, 0, 1e-6F);
    EXPECT_FLOAT_EQ(value.normal.y, 1);
  }
}

TEST(PaintedFrame, LeavesIlluminationAsItIs) {
  const Scene scene = floor_of(lambert({0.5F, 0.4F, 0.2F}), lambert({0.001F, 0, 0}));
  PaintedFrame frame = frame_of({1, 2, 3});
  frame.content = PictureContent::kIllumination;
  const FrameValues read = values_of_frame(RayTracer(scene), frame);
  EXPECT_GT(read.counts.used, std::size_t(kWidth - 2) * kHeight);
  for (const SurfaceValue& value : read.values) EXPECT_EQ(value.illumination, (Vec3f{1, 2, 3}));
}

// The middle of pixel (x, y) meets the floor where its ray does: closed form of a pinhole.
TEST(PaintedFrame, PutsPixelsWhereTheCameraSeesThem) {
  const Scene scene = floor_of(lambert({1, 1, 1}), lambert({1, 1, 1}));
  PaintedFrame frame = frame_of({1, 1, 1});
  frame.weight.assign(frame.weight.size(), 0);
  frame.weight[std::size_t(10) * kWidth + 50] = 0.25F;
  const FrameValues read = values_of_frame(RayTracer(scene), frame);
  ASSERT_EQ(read.values.size(), 1U);
  EXPECT_EQ(read.counts.masked, frame.weight.size() - 1);
  const float per_pixel = 3 * std::tan(0.3F) * 2 / kHeight;
  EXPECT_NEAR(read.values[0].position.x, (50.5F - kWidth / 2.0F) * per_pixel, 1e-4F);
  EXPECT_NEAR(read.values[0].position.z, (10.5F - kHeight / 2.0F) * per_pixel, 1e-4F);
  EXPECT_EQ(read.values[0].weight, 0.25F);
}

TEST(PaintedFrame, LeavesOutWhatTellsNoIllumination) {
  Material mirror = lambert({0.8F, 0.8F, 0.8F});
  mirror.lambert = false;
  mirror.metallic = 1;
  mirror.roughness = 0.05F;
  const struct {
    Material material;
    std::size_t PixelCounts::*count;
  } cases[] = {{mirror, &PixelCounts::shiny},
               {lambert({0.5F, 0.5F, 0.5F}, {10, 10, 10}), &PixelCounts::shiny},
               {lambert({0.5F, 0.5F, 0.001F}), &PixelCounts::dark}};
  for (const auto& [material, member] : cases) {
    const Scene scene = floor_of(lambert({0.5F, 0.5F, 0.5F}), material);
    const FrameValues read = values_of_frame(RayTracer(scene), frame_of({1, 1, 1}));
    const PixelCounts& counts = read.counts;
    EXPECT_EQ(total(counts), std::size_t(kWidth) * kHeight);
    EXPECT_GT(counts.*member, std::size_t(kWidth / 2 - 2) * kHeight);
    EXPECT_GT(counts.used, std::size_t(kWidth / 2 - 2) * kHeight);
    for (const SurfaceValue& value : read.values) EXPECT_LT(value.position.x, 0.01F);
  }
}

TEST(PaintedFrame, LeavesOutBackgroundEdgesAndWhatIsNotFinite) {
  Scene scene;
  test::add_mesh(scene, test::rectangle({-0.5F, 0, 0.5F}, {1, 0, 0}, {0, 0, -1}), lambert({0.5F, 0.5F, 0.5F}), "low");
  test::add_mesh(scene, test::rectangle({-0.25F, 1, 0.25F}, {0.5F, 0, 0}, {0, 0, -0.5F}), lambert({0.5F, 0.5F, 0.5F}),
                 "high");
  PaintedFrame frame = frame_of({1, 1, 1});
  const std::size_t middle = std::size_t(kHeight / 2) * kWidth + kWidth / 2;
  frame.pixels[middle].y = std::numeric_limits<float>::quiet_NaN();
  frame.pixels[middle + 1].z = -1;
  frame.pixels[middle + 2].x = std::numeric_limits<float>::max();  // finite only until the albedo divides it
  const PixelCounts counts = values_of_frame(RayTracer(scene), frame).counts;
  EXPECT_EQ(counts.invalid, 3U);
  EXPECT_GT(counts.background, 0U);
  EXPECT_GT(counts.edge, 0U);
  EXPECT_LT(counts.edge, 400U);  // about one pixel along two squares
  EXPECT_EQ(total(counts), std::size_t(kWidth) * kHeight);
}

}  // namespace
}  // namespace chiaro::inverse
