#include "renderer/image/texel_encoding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "renderer/image/srgb_curve.h"

namespace chiaro::renderer {
namespace {

template <class Channel>
DecodeTableOf<Channel> make_srgb_table() {
  constexpr double kOne = std::numeric_limits<Channel>::max();
  DecodeTableOf<Channel> table;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = float(linear_from_srgb(double(i) / kOne));
  return table;
}

template <class Channel>
DecodeTableOf<Channel> make_linear_table() {
  constexpr float kOne = std::numeric_limits<Channel>::max();
  DecodeTableOf<Channel> table;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = float(i) / kOne;
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

template <class Channel>
const DecodeTableOf<Channel>& decode_table(bool srgb) {
  static const DecodeTableOf<Channel> kSrgb = make_srgb_table<Channel>(), kLinear = make_linear_table<Channel>();
  return srgb ? kSrgb : kLinear;
}

template const DecodeTableOf<std::uint8_t>& decode_table<std::uint8_t>(bool);
template const DecodeTableOf<std::uint16_t>& decode_table<std::uint16_t>(bool);

std::uint8_t encode_srgb(float linear) {
  static const std::vector<std::uint8_t> kTable = make_encode_table();
  return kTable[std::size_t(std::clamp(linear, 0.0F, 1.0F) * kEncodeSteps + 0.5F)];
}

std::uint16_t encode_wide_srgb(float linear) {
  return std::uint16_t(std::lround(65535 * srgb_from_linear(double(std::clamp(linear, 0.0F, 1.0F)))));
}

}  // namespace chiaro::renderer
