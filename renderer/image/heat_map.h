#pragma once
// Values as colours, dark violet over red to light yellow.

#include "renderer/core/vec.h"
#include "renderer/image/image.h"

namespace chiaro::renderer {

// The colour of a value from 0 to 1, on the sRGB curve: its lightness rises evenly, as the eye sees it, and its hue
// turns with it. What is beyond is clamped, NaN is the colour of 0.
Vec3f heat_color(float value);

// The first channel of `values` as heat_color shows it.
Image heat_map(const Image& values);

}  // namespace chiaro::renderer
