#include "inverse/target/illumination_picture.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

// Looks down from 5 m at 4 × 4 m of the plane y = 0: x to the right, z down the picture.
renderer::Camera camera_above() {
  renderer::Camera camera;
  const float half = std::sqrt(0.5F);
  camera.world_from_camera = renderer::make_transform({0, 5, 0}, {-half, 0, 0, half}, {1, 1, 1});
  camera.orthographic = true;
  camera.half_width = camera.half_height = 2;
  return camera;
}

Target linear_target(const renderer::Scene& scene) {
  Target target;
  target.receivers = make_receivers(scene, {.max_edge = 1});
  for (const Vec3f p : target.receivers.positions) target.illumination.push_back({10 + p.x, 10 + p.z, 3});
  target.weight.assign(target.receivers.size(), 1);
  return target;
}

TEST(IlluminationPicture, InterpolatesBetweenReceivers) {
  const renderer::Scene scene = test::plane_scene({0.2F, 0.2F, 0.2F});
  const renderer::RayTracer tracer(scene);
  const renderer::Image picture = illumination_picture(tracer, linear_target(scene), {camera_above(), 16, 16});
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const float* pixel = picture.at(x, y);
      EXPECT_NEAR(pixel[0], 10 - 2 + (float(x) + 0.5F) / 4, 1e-3F);
      EXPECT_NEAR(pixel[1], 10 - 2 + (float(y) + 0.5F) / 4, 1e-3F);
      EXPECT_NEAR(pixel[2], 3, 1e-4F);
      EXPECT_EQ(pixel[3], 1);
    }
  }
}

TEST(IlluminationPicture, IsClearWhereTheTargetKnowsNothing) {
  const renderer::Scene scene = test::plane_scene({0.2F, 0.2F, 0.2F});
  const renderer::RayTracer tracer(scene);
  Target target = linear_target(scene);
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    if (target.receivers.positions[i].x < 0.5F) target.weight[i] = 0, target.illumination[i] = {1e6F, 1e6F, 1e6F};
  }
  renderer::Camera camera = camera_above();
  const renderer::Image picture = illumination_picture(tracer, target, {camera, 16, 16});
  EXPECT_EQ(picture.at(2, 8)[3], 0);
  EXPECT_EQ(picture.at(14, 8)[3], 1);
  for (int x = 0; x < 16; ++x) EXPECT_LT(picture.at(x, 8)[0], 20) << "what weighs nothing does not show";
  camera.world_from_camera = renderer::make_transform({0, 5, 0}, {std::sqrt(0.5F), 0, 0, std::sqrt(0.5F)}, {1, 1, 1});
  EXPECT_EQ(illumination_picture(tracer, target, {camera, 4, 4}).at(2, 2)[3], 0) << "the sky";
}

}  // namespace
}  // namespace chiaro::inverse
