#include "renderer/image/mip_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "renderer/image/texel_encoding.h"

namespace chiaro::renderer {
namespace {

// The up to three texels of a row that one texel of the next level covers, and by how much.
struct Taps {
  int first = 0, count = 0;
  float weight[3] = {};
};

std::vector<Taps> taps_of(int from, int to) {
  std::vector<Taps> all(to);
  for (int i = 0; i < to; ++i) {
    const std::int64_t begin = std::int64_t(i) * from, end = begin + from;  // in texels / to
    Taps& taps = all[i];
    taps.first = int(begin / to);
    for (std::int64_t texel = taps.first; texel * to < end; ++texel) {
      const std::int64_t covered = std::min(end, (texel + 1) * to) - std::max(begin, texel * to);
      taps.weight[taps.count++] = float(double(covered) / from);
    }
  }
  return all;
}

// A level as it is averaged into the next: linear, not rounded to what texels can hold.
struct LinearLevel {
  int width, height;
  std::vector<float> rgba;

  const float* at(int x, int y) const { return &rgba[4 * (std::size_t(y) * width + x)]; }
};

template <class Channel>
constexpr float kOne = std::numeric_limits<Channel>::max();

// The same of the texture itself, texel by texel.
template <class Channel>
class LinearTexels {
 public:
  LinearTexels(const MipLevelOf<Channel>& level, const MipOptions& options)
      : width(level.width), height(level.height), texels_(level.texels), table_(decode_table<Channel>(options.srgb)) {}

  std::array<float, 4> at(int x, int y) const {
    const Channel* texel = texels_ + 4 * (std::size_t(y) * width + x);
    return {table_[texel[0]], table_[texel[1]], table_[texel[2]], float(texel[3]) / kOne<Channel>};
  }

  const int width, height;

 private:
  const Channel* texels_;
  const DecodeTableOf<Channel>& table_;
};

template <class Level>
std::array<float, 4> mean_of(const Level& from, const Taps& across, const Taps& down, bool alpha_weighted) {
  float rgb[3] = {}, weighted[3] = {}, alpha_sum = 0;
  for (int j = 0; j < down.count; ++j) {
    for (int i = 0; i < across.count; ++i) {
      const auto texel = from.at(across.first + i, down.first + j);
      const float weight = down.weight[j] * across.weight[i], alpha = weight * texel[3];
      for (int c = 0; c < 3; ++c) {
        rgb[c] += weight * texel[c];
        weighted[c] += alpha * texel[c];
      }
      alpha_sum += alpha;
    }
  }
  if (!alpha_weighted || !(alpha_sum > 0)) return {rgb[0], rgb[1], rgb[2], alpha_sum};
  return {weighted[0] / alpha_sum, weighted[1] / alpha_sum, weighted[2] / alpha_sum, alpha_sum};
}

template <class Level>
LinearLevel half_of(const Level& from, bool alpha_weighted) {
  LinearLevel level{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
  const std::vector<Taps> across = taps_of(from.width, level.width), down = taps_of(from.height, level.height);
  level.rgba.reserve(4 * std::size_t(level.width) * level.height);
  for (const Taps& rows : down) {
    for (const Taps& columns : across) {
      const std::array<float, 4> mean = mean_of(from, columns, rows, alpha_weighted);
      level.rgba.insert(level.rgba.end(), mean.begin(), mean.end());
    }
  }
  return level;
}

template <class Channel>
Channel encode(float value, bool srgb) {
  value = std::min(value, 1.0F);
  if (!srgb) return Channel(kOne<Channel> * value + 0.5F);
  if constexpr (sizeof(Channel) == 1) {
    return encode_srgb(value);
  } else {
    return encode_wide_srgb(value);
  }
}

template <class Channel>
std::vector<Channel> texels_of(const LinearLevel& level, bool srgb) {
  std::vector<Channel> texels(level.rgba.size());
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = encode<Channel>(level.rgba[i], srgb && i % 4 < 3);
  return texels;
}

template <class Channel>
void make_levels(Texture& texture, const MipOptions& options) {
  if (texture.width <= 1 && texture.height <= 1) return;
  auto& mips = mips_of<Channel>(texture);
  LinearLevel level = half_of(LinearTexels<Channel>(mip_level<Channel>(texture, 0), options), options.alpha_weighted);
  mips.push_back(texels_of<Channel>(level, options.srgb));
  while (level.width > 1 || level.height > 1) {
    level = half_of(level, options.alpha_weighted);
    mips.push_back(texels_of<Channel>(level, options.srgb));
  }
}

void widen(Texture& texture) {
  constexpr std::uint16_t kBytePattern = 0x0101;
  texture.wide_rgba.reserve(texture.rgba.size());
  for (const std::uint8_t value : texture.rgba) texture.wide_rgba.push_back(std::uint16_t(kBytePattern * value));
  texture.rgba = {};
}

}  // namespace

void make_mip_maps(Texture& texture, const MipOptions& options) {
  if (has_mips(texture)) return;
  if (options.wide && !is_wide(texture)) widen(texture);
  if (is_wide(texture)) {
    make_levels<std::uint16_t>(texture, options);
  } else {
    make_levels<std::uint8_t>(texture, options);
  }
}

}  // namespace chiaro::renderer
