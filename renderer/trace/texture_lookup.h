#pragma once

#include "renderer/core/vec.h"
#include "renderer/image/texture.h"

namespace chiaro::renderer {

// RGBA at uv, 0 to 1, bilinear in the stored values' linear light: colour textures are decoded from sRGB before
// filtering where `srgb` is set (alpha never is).
Vec4f look_up(const Texture& texture, Vec2f uv, bool srgb);

}  // namespace chiaro::renderer
