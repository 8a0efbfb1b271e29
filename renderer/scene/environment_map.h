#pragma once
// A picture of the light from infinitely far away, all around, on a latitude-longitude grid.
//   u  0 to 1 from the left: a quarter is a look along -Z, the middle one along +X, three quarters one along +Z
//   v  0 to 1 from the top, which is +Y
// so that a picture surrounds a glTF scene as Blender and three.js show it.

#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

struct EnvironmentMap {
  int width = 0, height = 0;
  std::vector<Vec3f> pixels;  // rows from the top; finite, not negative; times a light's intensity: radiance, cd/m²

  const Vec3f& at(int x, int y) const { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};

// Where a unit direction is on the map, and back.
Vec2f latlong_of(Vec3f direction);
Vec3f direction_of_latlong(Vec2f uv);

// The map at u, v, bilinear between the middles of its pixels, all the way round, and level beyond the first and last
// row.
Vec3f look_up(const EnvironmentMap& map, Vec2f uv);

// Rotated about +Y by radians, to the left as seen from within: -Z turns towards -X.
Vec3f rotate_about_y(Vec3f direction, float radians);

}  // namespace chiaro::renderer
