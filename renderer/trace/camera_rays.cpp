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

// Shirley, Chiu, A Low Distortion Map Between Disk and Square, 1997.
Vec2f concentric_disc(Vec2f u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {};
  const bool wide = std::abs(a) > std::abs(b);
  const float radius = wide ? a : b, angle = wide ? kPi / 4 * (b / a) : kPi / 2 - kPi / 4 * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

// One of the triangles between the centre and a side, and a point of it.
Vec2f regular_polygon(int corners, float rotation, Vec2f u) {
  const float scaled = u.x * float(corners), side = std::min(std::floor(scaled), float(corners - 1));
  const float root = std::sqrt(scaled - side), first = root * (1 - u.y), second = root * u.y;
  const float step = 2 * kPi / float(corners), angle = rotation + side * step;
  return first * Vec2f{std::cos(angle), std::sin(angle)} +
         second * Vec2f{std::cos(angle + step), std::sin(angle + step)};
}

}  // namespace

Vec2f sample_aperture(const Lens& lens, Vec2f u) {
  return lens.radius * (lens.blades > 2 ? regular_polygon(lens.blades, lens.rotation, u) : concentric_disc(u));
}

CameraRays::CameraRays(const Camera& camera, int width, int height, const Lens& lens)
    : world_from_camera_(without_scale(camera.world_from_camera)),
      orthographic_(camera.orthographic),
      lens_(lens),
      half_height_(camera.orthographic ? camera.half_height : std::tan(0.5F * camera.vertical_fov)),
      size_{float(width), float(height)} {
  half_width_ = half_height_ * size_.x / size_.y;
}

Ray CameraRays::at(Vec2f film, Vec2f u) const {
  const float x = (2 * film.x / size_.x - 1) * half_width_, y = (1 - 2 * film.y / size_.y) * half_height_;
  Vec3f origin = orthographic_ ? Vec3f{x, y, 0} : Vec3f{};
  Vec3f toward = orthographic_ ? Vec3f{0, 0, -1} : Vec3f{x, y, -1};
  if (lens_.radius > 0) {
    const Vec2f aperture = sample_aperture(lens_, u);
    const Vec3f on_lens{aperture.x, aperture.y, 0};
    toward = lens_.focus_distance * toward - on_lens;
    origin = origin + on_lens;
  }
  Ray ray;
  ray.origin = transform_point(world_from_camera_, origin);
  ray.direction = normalize(transform_direction(world_from_camera_, toward));
  const float pixel = 2 * half_height_ / size_.y;
  (orthographic_ ? ray.cone_width : ray.cone_spread) = pixel;
  return ray;
}

}  // namespace chiaro::renderer
