#pragma once

#include "renderer/core/vec.h"
#include "renderer/image/texture.h"

namespace chiaro::renderer {

// RGBA at uv, 0 to 1, bilinear in the stored values' linear light: colour textures are decoded from sRGB before
// filtering where `srgb` is set (alpha never is), unless the texture is filtered as stored. level: of the mip map, if
// there is one.
Vec4f look_up(const Texture& texture, Vec2f uv, bool srgb, int level = 0);

// Alpha of the full texture.
float look_up_alpha(const Texture& texture, Vec2f uv);

// The level of which four to eight texels span the footprint of a ray. footprint_texels: area of the footprint in
// texels of level 0. Texels are that small so that neither they nor the step to the next level show behind the pixel
// filter, and what is finer is left to the samples of a pixel, along with the longer side of footprints at grazing
// angles.
// Source: Akenine-Möller et al., Improved Shader and Texture Level of Detail Using Ray Cones, JCGT 10(1), 2021.
int mip_level_of(float footprint_texels);

}  // namespace chiaro::renderer
