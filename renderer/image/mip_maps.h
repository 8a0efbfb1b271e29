#pragma once
// Smaller versions of a texture, each half as wide and high as the one before, down to one texel.
// Source: Williams, Pyramidal Parametrics, 1983.

#include "renderer/image/texture.h"

namespace chiaro::renderer {

struct MipOptions {
  bool srgb = false;            // averaged in linear light, and encoded again
  bool alpha_weighted = false;  // where alpha is coverage: what is not there has no say in the colour
  bool wide = false;            // 16 bits, where the texture has 8: of few bright texels among dark ones
};

// Makes the mip maps of a texture that has none. Every level's mean is the texture's, but for the rounding of
// that level: sides that are odd or no powers of two are averaged with fractional weights.
void make_mip_maps(Texture& texture, const MipOptions& options);

}  // namespace chiaro::renderer
