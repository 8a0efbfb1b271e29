#pragma once
// 8-bit texels and the linear values that they stand for.

#include <array>
#include <cstdint>

namespace chiaro::renderer {

using DecodeTable = std::array<float, 256>;

// sRGB of IEC 61966-2-1, or 0 to 1 in equal steps.
const DecodeTable& decode_table(bool srgb);

// The nearest 8-bit sRGB value of a linear one, 0 to 1.
std::uint8_t encode_srgb(float linear);

}  // namespace chiaro::renderer
