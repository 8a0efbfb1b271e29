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

// Where a ray meets the plane across the camera's axis at a distance.
Vec3f at_distance(const Ray& ray, float distance) {
  return ray.origin + ((-distance - ray.origin.z) / ray.direction.z) * ray.direction;
}

TEST(CameraRays, BlurIsTheThinLens) {
  // A 50 mm lens at f/2 before film of 24 mm, focused at F. On the film, a point at distance z blurs to a disc of
  // diameter c = A |z − F| / z · f / (F − f), A = f / N; the film stands at f F / (F − f) behind the lens.
  constexpr float kFocal = 0.05F, kAperture = kFocal / 2, kFocus = 3;
  constexpr float kFilm = kFocal * kFocus / (kFocus - kFocal);
  Camera camera;
  camera.vertical_fov = 2 * std::atan(0.5F * 0.024F / kFilm);
  const CameraRays rays(camera, 300, 200, {.radius = 0.5F * kAperture, .focus_distance = kFocus});
  const float pixel = 0.024F / 200;
  for (const float z : {0.8F, 2.0F, 3.0F, 5.0F, 100.0F}) {
    const float c = kAperture * std::abs(z - kFocus) / z * kFocal / (kFocus - kFocal);
    const Vec3f point{0.1F * z, -0.05F * z, -z};
    const Vec2f seen{150 + 0.1F * kFilm / pixel, 100 + 0.05F * kFilm / pixel};
    float largest = 0;
    for (int i = 0; i < 64; ++i) {
      // Around the rim of the lens, and a film position moved until the ray meets the point.
      const Vec2f u{float(i) / 64, 0};
      const Vec3f miss = at_distance(rays.at(seen, u), z) - point;
      const float per_pixel = at_distance(rays.at({151, 100}, u), z).x - at_distance(rays.at({150, 100}, u), z).x;
      largest = std::max(largest, length(miss) / per_pixel * pixel);
    }
    EXPECT_NEAR(largest, 0.5F * c, 0.002F * c + 1e-7F) << z;
  }
}

TEST(CameraRays, OrthographicLensesFocusToo) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height = 2;
  const CameraRays rays(camera, 100, 100, {.radius = 0.1F, .focus_distance = 4});
  for (const Vec2f u : {Vec2f{0, 0.3F}, {0.9F, 0.1F}, {0.4F, 0.6F}})
    expect_near(at_distance(rays.at({75, 25}, u), 4), {1, 1, -4});
}

TEST(CameraRays, AperturesAreUniform) {
  // Mean and mean square of the distance from the centre: 2R/3 and R²/2 of a disc; a regular polygon of n corners has
  // R²/6 (2 + cos 2π/n) for the latter.
  constexpr int kSide = 128;
  for (const int blades : {0, 3, 6}) {
    const Lens lens{.radius = 2, .focus_distance = 1, .blades = blades, .rotation = 0.3F};
    double square = 0, x = 0, y = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec2f p = sample_aperture(lens, {(float(i % kSide) + 0.5F) / kSide, (float(i / kSide) + 0.5F) / kSide});
      square += double(p.x * p.x + p.y * p.y) / (kSide * kSide);
      x += double(p.x) / (kSide * kSide), y += double(p.y) / (kSide * kSide);
      EXPECT_LE(p.x * p.x + p.y * p.y, 4.0001F);
    }
    const double expected = blades == 0 ? 2 : 4.0 / 6 * (2 + std::cos(2 * double(kPi) / blades));
    EXPECT_NEAR(square, expected, 0.02) << blades;
    EXPECT_NEAR(x, 0, 0.02);
    EXPECT_NEAR(y, 0, 0.02);
  }
}

TEST(CameraRays, AperturesTurn) {
  constexpr int kSide = 256;
  for (const float rotation : {0.0F, 0.4F, 1.0F}) {
    const Lens lens{.radius = 2, .focus_distance = 1, .blades = 3, .rotation = rotation};
    Vec2f corner{0, 0};
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec2f p = sample_aperture(lens, {(float(i % kSide) + 0.5F) / kSide, (float(i / kSide) + 0.5F) / kSide});
      if (p.x * p.x + p.y * p.y > corner.x * corner.x + corner.y * corner.y) corner = p;
    }
    const float sides = 3 * (std::atan2(corner.y, corner.x) - rotation);  // whole turns
    EXPECT_NEAR(std::cos(sides), 1, 0.02) << rotation;
  }
}

TEST(CameraRays, ConesAreAPixelWide) {
  Camera camera;
  camera.vertical_fov = 1;
  const CameraRays perspective(camera, 200, 100);
  const float apart = length(at_distance(perspective.at({100, 50}), 1) - at_distance(perspective.at({101, 50}), 1));
  EXPECT_NEAR(perspective.at({100, 50}).cone_spread, apart, 1e-5F);
  EXPECT_EQ(perspective.at({100, 50}).cone_width, 0);
  camera.orthographic = true;
  EXPECT_NEAR(CameraRays(camera, 200, 100).at({9, 9}).cone_width, 0.02F, 1e-6F);
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
