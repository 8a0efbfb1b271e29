#include "renderer/scene/environment_map.h"

namespace chiaro::renderer {

Vec2f latlong_of(Vec3f direction) {
  const float u = 0.5F + std::atan2(direction.z, direction.x) / (2 * kPi);
  const float v = std::atan2(std::hypot(direction.x, direction.z), direction.y) / kPi;
  return {u, v};
}

Vec3f direction_of_latlong(Vec2f uv) {
  const float phi = 2 * kPi * (uv.x - 0.5F), theta = kPi * uv.y, sine = std::sin(theta);
  return {sine * std::cos(phi), std::cos(theta), sine * std::sin(phi)};
}

Vec3f look_up(const EnvironmentMap& map, Vec2f uv) {
  const float x = uv.x * float(map.width) - 0.5F;
  const float y = std::clamp(uv.y * float(map.height) - 0.5F, 0.0F, float(map.height - 1));
  const float left = std::floor(x);
  const int column = int(left) < 0 ? map.width - 1 : std::min(int(left), map.width - 1), row = int(y);
  const int next_column = column + 1 < map.width ? column + 1 : 0, next_row = std::min(row + 1, map.height - 1);
  const float s = x - left, t = y - float(row);
  return lerp(t, lerp(s, map.at(column, row), map.at(next_column, row)),
              lerp(s, map.at(column, next_row), map.at(next_column, next_row)));
}

Vec3f rotate_about_y(Vec3f d, float radians) {
  const float c = std::cos(radians), s = std::sin(radians);
  return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

}  // namespace chiaro::renderer
