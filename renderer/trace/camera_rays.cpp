#include "renderer/trace/camera_rays.h"

namespace chiaro::renderer {
namespace {

// Rigid part of a camera's transform: a scale above a camera must not change its picture.
Mat4f without_scale(const Mat4f& m) {
  Mat4f rigid = m;
  for (int c = 0; c < 3; ++c) {
    const Vec3f axis = normalize(m.column(c));
    for (int row = 0; row < 3; ++row) rigid(row, c) = axis[row];
  }
  return rigid;
}

}  // namespace

CameraRays::CameraRays(const Camera& camera, int width, int height)
    : world_from_camera_(without_scale(camera.world_from_camera)),
      orthographic_(camera.orthographic),
      half_height_(camera.orthographic ? camera.half_height : std::tan(0.5F * camera.vertical_fov)),
      size_{float(width), float(height)} {
  half_width_ = half_height_ * size_.x / size_.y;
}

Ray CameraRays::at(Vec2f film) const {
  const float x = (2 * film.x / size_.x - 1) * half_width_, y = (1 - 2 * film.y / size_.y) * half_height_;
  const Vec3f local_origin = orthographic_ ? Vec3f{x, y, 0} : Vec3f{};
  const Vec3f toward = orthographic_ ? Vec3f{0, 0, -1} : Vec3f{x, y, -1};
  Ray ray;
  ray.origin = transform_point(world_from_camera_, local_origin);
  ray.direction = normalize(transform_direction(world_from_camera_, toward));
  return ray;
}

}  // namespace chiaro::renderer
