#include "renderer/image/mip_maps.h"

#include <algorithm>
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

struct Sums {
  float rgb[3] = {}, weighted[3] = {}, alpha = 0;
};

template <class Channel>
Sums sums_of(const MipLevelOf<Channel>& from, const Taps& across, const Taps& down,
             const DecodeTableOf<Channel>& table) {
  Sums s;
  for (int j = 0; j < down.count; ++j) {
    const Channel* texel = from.texels + 4 * (std::size_t(down.first + j) * from.width + across.first);
    for (int i = 0; i < across.count; ++i, texel += 4) {
      const float weight = down.weight[j] * across.weight[i], alpha = weight * float(texel[3]);
      for (int c = 0; c < 3; ++c) {
        s.rgb[c] += weight * table[texel[c]];
        s.weighted[c] += alpha * table[texel[c]];
      }
      s.alpha += alpha;
    }
  }
  return s;
}

template <class Channel>
constexpr float kOne = std::numeric_limits<Channel>::max();

template <class Channel>
Channel encode(float value, const MipOptions& options) {
  if (!options.srgb) return Channel(kOne<Channel> * value + 0.5F);
  if constexpr (sizeof(Channel) == 1) {
    return encode_srgb(value);
  } else {
    return encode_wide_srgb(value);
  }
}

template <class Channel>
std::vector<Channel> half_of(const MipLevelOf<Channel>& from, const MipOptions& options) {
  const int width = std::max(1, from.width / 2), height = std::max(1, from.height / 2);
  const std::vector<Taps> across = taps_of(from.width, width), down = taps_of(from.height, height);
  const DecodeTableOf<Channel>& table = decode_table<Channel>(options.srgb);
  std::vector<Channel> texels(4 * std::size_t(width) * height);
  Channel* out = texels.data();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, out += 4) {
      const Sums s = sums_of(from, across[x], down[y], table);
      const bool weighted = options.alpha_weighted && s.alpha > 0;
      for (int c = 0; c < 3; ++c)
        out[c] = encode<Channel>(std::min(weighted ? s.weighted[c] / s.alpha : s.rgb[c], 1.0F), options);
      out[3] = Channel(std::min(s.alpha + 0.5F, kOne<Channel>));
    }
  }
  return texels;
}

template <class Channel>
void make_levels(Texture& texture, const MipOptions& options) {
  auto& mips = mips_of<Channel>(texture);
  MipLevelOf<Channel> level = mip_level<Channel>(texture, 0);
  while (level.width > 1 || level.height > 1) {
    mips.push_back(half_of(level, options));
    level = mip_level<Channel>(texture, int(mips.size()));
  }
}

}  // namespace

void make_mip_maps(Texture& texture, const MipOptions& options) {
  if (has_mips(texture)) return;
  if (is_wide(texture)) {
    make_levels<std::uint16_t>(texture, options);
  } else {
    make_levels<std::uint8_t>(texture, options);
  }
}

}  // namespace chiaro::renderer
