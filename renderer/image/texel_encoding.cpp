#include "renderer/image/texel_encoding.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/image/srgb_curve.h"

namespace chiaro::renderer {
namespace {

DecodeTable make_srgb_table() {
  DecodeTable table;
  for (int i = 0; i < 256; ++i) table[i] = float(linear_from_srgb(i / 255.0));
  return table;
}

DecodeTable make_linear_table() {
  DecodeTable table;
  for (int i = 0; i < 256; ++i) table[i] = float(i) / 255.0F;
  return table;
}

// Fine enough for the darkest step of sRGB, 1/3295.
constexpr int kEncodeSteps = 1 << 15;

std::vector<std::uint8_t> make_encode_table() {
  std::vector<std::uint8_t> table(kEncodeSteps + 1);
  for (int i = 0; i <= kEncodeSteps; ++i) {
    const double v = double(i) / kEncodeSteps;
    table[i] = std::uint8_t(std::lround(255 * srgb_from_linear(v)));
  }
  return table;
}

}  // namespace

const DecodeTable& decode_table(bool srgb) {
  static const DecodeTable kSrgb = make_srgb_table(), kLinear = make_linear_table();
  return srgb ? kSrgb : kLinear;
}

std::uint8_t encode_srgb(float linear) {
  static const std::vector<std::uint8_t> kTable = make_encode_table();
  return kTable[std::size_t(std::clamp(linear, 0.0F, 1.0F) * kEncodeSteps + 0.5F)];
}

}  // namespace chiaro::renderer
