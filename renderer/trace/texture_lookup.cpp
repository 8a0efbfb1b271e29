#include "renderer/trace/texture_lookup.h"

#include <bit>
#include <limits>

#include "renderer/image/texel_encoding.h"

namespace chiaro::renderer {
namespace {

const DecodeTable kSrgb = decode_table(true), kLinear = decode_table(false);

// Nearly all textures have 8 bits, and wait for no table to be made.
template <class Channel>
const DecodeTableOf<Channel>& table_of(bool srgb) {
  if constexpr (sizeof(Channel) == 1) {
    return srgb ? kSrgb : kLinear;
  } else {
    return decode_table<Channel>(srgb);
  }
}

template <class Channel>
constexpr float kOne = std::numeric_limits<Channel>::max();

// Two neighbouring texels of a row or column, and the share of the second.
struct Neighbours {
  int first = 0, second = 0;
  float t = 0;
};

// uv to 0 … 1, where 0 and 1 are the texture's sides.
float wrapped(float uv, Wrap mode) {
  if (mode == Wrap::kClampToEdge) return std::clamp(uv, 0.0F, 1.0F);
  if (mode == Wrap::kRepeat) return uv - std::floor(uv);
  const float twice = uv - 2 * std::floor(0.5F * uv);
  return twice > 1 ? 2 - twice : twice;
}

int nearest(float uv, int size, Wrap mode) { return std::min(int(wrapped(uv, mode) * float(size)), size - 1); }

Neighbours neighbours(float uv, int size, Wrap mode) {
  const float x = wrapped(uv, mode) * float(size) - 0.5F, floor = std::floor(x);
  Neighbours n{int(floor), int(floor) + 1, x - floor};
  const bool repeats = mode == Wrap::kRepeat;
  if (n.first < 0) n.first = repeats ? size - 1 : 0;
  if (n.second >= size) n.second = repeats ? 0 : size - 1;
  return n;
}

// At a value, 0 to the table's last, between two that are stored.
template <class Table>
float decode_between(const Table& table, float value) {
  const int below = std::clamp(int(value), 0, int(table.size()) - 2);
  const float t = value - float(below);
  return (1 - t) * table[below] + t * table[below + 1];
}

bool is_finite(Vec2f uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); }

template <class Channel>
Vec4f look_up_in(const Texture& texture, Vec2f uv, bool srgb, int level) {
  using Table = DecodeTableOf<Channel>;
  const Table &alpha = table_of<Channel>(false), &color = srgb ? table_of<Channel>(true) : alpha;
  const MipLevelOf<Channel> mip = mip_level<Channel>(texture, texture.nearest ? 0 : level);
  const auto at = [&](int x, int y) {
    return mip.texels + 4 * (std::size_t(y) * std::size_t(mip.width) + std::size_t(x));
  };
  if (texture.nearest) {
    const auto* p = at(nearest(uv.x, mip.width, texture.wrap_u), nearest(uv.y, mip.height, texture.wrap_v));
    return {color[p[0]], color[p[1]], color[p[2]], alpha[p[3]]};
  }
  const Neighbours x = neighbours(uv.x, mip.width, texture.wrap_u), y = neighbours(uv.y, mip.height, texture.wrap_v);
  const Channel *a = at(x.first, y.first), *b = at(x.second, y.first), *c = at(x.first, y.second),
                *d = at(x.second, y.second);
  const float wd = x.t * y.t, wb = x.t - wd, wc = y.t - wd, wa = 1 - x.t - wc;
  const auto channel = [&](int k, const Table& table) {
    return wa * table[a[k]] + wb * table[b[k]] + wc * table[c[k]] + wd * table[d[k]];
  };
  if (srgb && texture.filtered_as_stored) {
    const auto decoded = [&](int k) { return decode_between(color, kOne<Channel> * channel(k, alpha)); };
    return {decoded(0), decoded(1), decoded(2), channel(3, alpha)};
  }
  return {channel(0, color), channel(1, color), channel(2, color), channel(3, alpha)};
}

template <class Channel>
float look_up_alpha_in(const Texture& texture, Vec2f uv) {
  const std::vector<Channel>& rgba = rgba_of<Channel>(texture);
  const auto at = [&](int x, int y) {
    return float(rgba[4 * (std::size_t(y) * std::size_t(texture.width) + std::size_t(x)) + 3]) / kOne<Channel>;
  };
  if (texture.nearest) {
    return at(nearest(uv.x, texture.width, texture.wrap_u), nearest(uv.y, texture.height, texture.wrap_v));
  }
  const Neighbours x = neighbours(uv.x, texture.width, texture.wrap_u);
  const Neighbours y = neighbours(uv.y, texture.height, texture.wrap_v);
  const float top = (1 - x.t) * at(x.first, y.first) + x.t * at(x.second, y.first);
  const float low = (1 - x.t) * at(x.first, y.second) + x.t * at(x.second, y.second);
  return (1 - y.t) * top + y.t * low;
}

}  // namespace

Vec4f look_up(const Texture& texture, Vec2f uv, bool srgb, int level) {
  if (!is_finite(uv)) uv = {};
  return is_wide(texture) ? look_up_in<std::uint16_t>(texture, uv, srgb, level)
                          : look_up_in<std::uint8_t>(texture, uv, srgb, level);
}

float look_up_alpha(const Texture& texture, Vec2f uv) {
  if (!is_finite(uv)) uv = {};
  return is_wide(texture) ? look_up_alpha_in<std::uint16_t>(texture, uv) : look_up_alpha_in<std::uint8_t>(texture, uv);
}

int mip_level_of(float footprint_texels) {
  constexpr float kTexelsAcross = 4;
  const float texels = footprint_texels / (kTexelsAcross * kTexelsAcross);
  if (!(texels >= 4)) return 0;
  // floor(log2 √texels), by the float's own exponent.
  return (int(std::bit_cast<std::uint32_t>(texels) >> 23) - 127) / 2;
}

}  // namespace chiaro::renderer
