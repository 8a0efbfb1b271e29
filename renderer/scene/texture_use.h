#pragma once

#include <array>
#include <cmath>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

// An affine map of texture coordinates: u' = m[0] u + m[1] v + m[2], v' = m[3] u + m[4] v + m[5].
struct UvTransform {
  std::array<float, 6> m{1, 0, 0, 0, 1, 0};

  Vec2f operator()(Vec2f uv) const { return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]}; }
  float area_scale() const { return std::abs(m[0] * m[4] - m[1] * m[3]); }
};

// As KHR_texture_transform: scaled, turned (radians, counter-clockwise as seen with v downwards), moved.
inline UvTransform make_uv_transform(Vec2f offset, float rotation, Vec2f scale) {
  const float c = std::cos(rotation), s = std::sin(rotation);
  return {{c * scale.x, s * scale.y, offset.x, -s * scale.x, c * scale.y, offset.y}};
}

inline constexpr int kUvSetCount = 8;

// The use of a texture by a material; texture < 0: none.
struct TextureUse {
  int texture = -1;
  int uv_set = 0;            // less than kUvSetCount
  bool transformed = false;  // by `transform`
  UvTransform transform;
};

}  // namespace chiaro::renderer
