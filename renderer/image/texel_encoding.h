#pragma once
// Texels of 8 and 16 bits per channel, and the linear values that they stand for.

#include <array>
#include <cstdint>

namespace chiaro::renderer {

// Of channels that are std::uint8_t or std::uint16_t.
template <class Channel>
using DecodeTableOf = std::array<float, (std::size_t{1} << (8 * sizeof(Channel)))>;
using DecodeTable = DecodeTableOf<std::uint8_t>;

// sRGB of IEC 61966-2-1, or 0 to 1 in equal steps.
template <class Channel = std::uint8_t>
const DecodeTableOf<Channel>& decode_table(bool srgb);

// The nearest 8-bit, or 16-bit, sRGB value of a linear one, 0 to 1.
std::uint8_t encode_srgb(float linear);
std::uint16_t encode_wide_srgb(float linear);

}  // namespace chiaro::renderer
