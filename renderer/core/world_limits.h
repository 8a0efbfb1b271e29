#pragma once
// How large a world may be.

#include <cmath>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

// Metres from the origin, along any axis; fourth powers of distances remain floats.
inline constexpr float kWorldLimit = 1e9F;

inline bool in_world(Vec3f point) {
  return std::abs(point.x) <= kWorldLimit && std::abs(point.y) <= kWorldLimit && std::abs(point.z) <= kWorldLimit;
}

}  // namespace chiaro::renderer
