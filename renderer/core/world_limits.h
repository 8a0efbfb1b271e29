#pragma once
// How large, and how bright, a world may be.

#include <cmath>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

// Metres from the origin, along any axis; fourth powers of distances remain floats.
inline constexpr float kWorldLimit = 1e9F;

// Metres across: below this rays leave surfaces by more than what is on them.
inline constexpr float kLeastScene = 1e-5F;

// Metres between a coordinate and the next one that is a float.
inline float spacing_at(float coordinate) { return std::nextafter(coordinate, kInfinity) - coordinate; }

// Candela, lux or cd/m² of anything that gives light, and of what is wanted of it: a sun at the world's end.
inline constexpr float kBrightest = 1e24F;

// Of red, green and blue: light, and no more than there may be.
inline bool is_light(Vec3f value) {
  return is_finite(value) && min_component(value) >= 0 && max_component(value) <= kBrightest;
}

inline bool in_world(Vec3f point) {
  return std::abs(point.x) <= kWorldLimit && std::abs(point.y) <= kWorldLimit && std::abs(point.z) <= kWorldLimit;
}

}  // namespace chiaro::renderer
