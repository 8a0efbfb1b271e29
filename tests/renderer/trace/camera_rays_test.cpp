#include "renderer/trace/camera_rays.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

void expect_near(Vec3f a, Vec3f b) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5F);
}

TEST(CameraRays, CentreLooksAlongMinusZAndCornersSpanTheField) {
  Camera camera;
  camera.vertical_fov = 1;
  const CameraRays rays(camera, 200, 100);
  expect_near(rays.at({100, 50}).direction, {0, 0, -1});
  expect_near(rays.at({100, 50}).origin, {0, 0, 0});
  const float h = std::tan(0.5F);
  expect_near(rays.at({0, 0}).direction, normalize(Vec3f{-2 * h, h, -1}));
  expect_near(rays.at({200, 0}).direction, normalize(Vec3f{2 * h, h, -1}));
  expect_near(rays.at({0, 100}).direction, normalize(Vec3f{-2 * h, -h, -1}));
  expect_near(rays.at({200, 100}).direction, normalize(Vec3f{2 * h, -h, -1}));
}

TEST(CameraRays, HeightShowsTheVerticalFieldWhateverTheWidth) {
  Camera camera;
  camera.vertical_fov = 0.8F;
  for (const int width : {10, 100, 1000}) {
    const Vec3f top = CameraRays(camera, width, 100).at({0.5F * float(width), 0}).direction;
    EXPECT_NEAR(std::atan2(top.y, -top.z), 0.4F, 1e-5F);
  }
}

TEST(CameraRays, OrthographicRaysAreParallel) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height = 2;
  const CameraRays rays(camera, 300, 100);
  expect_near(rays.at({0, 0}).origin, {-6, 2, 0});
  expect_near(rays.at({300, 100}).origin, {6, -2, 0});
  expect_near(rays.at({0, 0}).direction, {0, 0, -1});
  expect_near(rays.at({300, 100}).direction, {0, 0, -1});
}

TEST(CameraRays, FollowTheCamerasPlaceButNotItsScale) {
  // A quarter turn about +Y: -Z becomes -X, and the camera's right, +X, becomes -Z.
  const float half = std::sqrt(0.5F);
  Camera camera;
  camera.vertical_fov = 1;
  for (const float scale : {1.0F, 7.0F}) {
    camera.world_from_camera = make_transform({1, 2, 3}, {0, half, 0, half}, {scale, scale, scale});
    const CameraRays rays(camera, 100, 100);
    expect_near(rays.at({50, 50}).origin, {1, 2, 3});
    expect_near(rays.at({50, 50}).direction, {-1, 0, 0});
    expect_near(rays.at({100, 50}).direction, normalize(Vec3f{-1, 0, -std::tan(0.5F)}));
  }
}

TEST(CameraRays, AreUnitAndNotClipped) {
  Camera camera;
  camera.near = 0.5F;
  camera.far = 20;
  const CameraRays rays(camera, 200, 100);
  for (const Vec2f film : {Vec2f{100, 50}, Vec2f{0, 0}, Vec2f{170, 20}}) {
    const Ray ray = rays.at(film);
    EXPECT_NEAR(length(ray.direction), 1, 1e-5F);
    EXPECT_EQ(ray.near, 0);
    EXPECT_EQ(ray.far, kInfinity);
  }
}

}  // namespace
}  // namespace chiaro::renderer
