#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/core/vec.h"

namespace chiaro::test {

// Uniform over the unit sphere, of two uniform random numbers.
inline renderer::Vec3f uniform_direction(renderer::Vec2f u) {
  const float z = 1 - 2 * u.x, sine = std::sqrt(std::max(0.0F, 1 - z * z)), phi = 2 * renderer::kPi * u.y;
  return {sine * std::cos(phi), sine * std::sin(phi), z};
}

}  // namespace chiaro::test
