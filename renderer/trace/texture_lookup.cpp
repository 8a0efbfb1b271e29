#include "renderer/trace/texture_lookup.h"

#include <array>

namespace chiaro::renderer {
namespace {

using DecodeTable = std::array<float, 256>;

// IEC 61966-2-1.
DecodeTable make_srgb_table() {
  DecodeTable table;
  for (int i = 0; i < 256; ++i) {
    const double v = i / 255.0;
    table[i] = float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }
  return table;
}

DecodeTable make_linear_table() {
  DecodeTable table;
  for (int i = 0; i < 256; ++i) table[i] = float(i) / 255.0F;
  return table;
}

const DecodeTable kSrgb = make_srgb_table();
const DecodeTable kLinear = make_linear_table();

int wrap(int i, int size, Wrap mode) {
  if (mode == Wrap::kClampToEdge) return std::clamp(i, 0, size - 1);
  const int period = mode == Wrap::kRepeat ? size : 2 * size;
  i %= period;
  if (i < 0) i += period;
  return i < size ? i : period - 1 - i;
}

Vec4f texel(const Texture& texture, int x, int y, const DecodeTable& table) {
  const std::uint8_t* p = &texture.rgba[4 * (std::size_t(y) * texture.width + x)];
  return {table[p[0]], table[p[1]], table[p[2]], kLinear[p[3]]};
}

}  // namespace

Vec4f look_up(const Texture& texture, Vec2f uv, bool srgb) {
  const DecodeTable& table = srgb ? kSrgb : kLinear;
  // Whole turns are taken off first, so that large coordinates keep their fraction and never overflow an int.
  const float u = (uv.x - 2 * std::floor(0.5F * uv.x)) * float(texture.width);
  const float v = (uv.y - 2 * std::floor(0.5F * uv.y)) * float(texture.height);
  const bool clamped_u = texture.wrap_u == Wrap::kClampToEdge, clamped_v = texture.wrap_v == Wrap::kClampToEdge;
  const float x = clamped_u ? std::clamp(uv.x, -1.0F, 2.0F) * float(texture.width) : u;
  const float y = clamped_v ? std::clamp(uv.y, -1.0F, 2.0F) * float(texture.height) : v;
  if (!std::isfinite(x) || !std::isfinite(y)) return texel(texture, 0, 0, table);
  if (texture.nearest) {
    return texel(texture, wrap(int(std::floor(x)), texture.width, texture.wrap_u),
                 wrap(int(std::floor(y)), texture.height, texture.wrap_v), table);
  }
  const float fx = std::floor(x - 0.5F), fy = std::floor(y - 0.5F);
  const float tx = x - 0.5F - fx, ty = y - 0.5F - fy;
  const int x0 = wrap(int(fx), texture.width, texture.wrap_u), x1 = wrap(int(fx) + 1, texture.width, texture.wrap_u);
  const int y0 = wrap(int(fy), texture.height, texture.wrap_v), y1 = wrap(int(fy) + 1, texture.height, texture.wrap_v);
  const Vec4f top = (1 - tx) * texel(texture, x0, y0, table) + tx * texel(texture, x1, y0, table);
  const Vec4f bottom = (1 - tx) * texel(texture, x0, y1, table) + tx * texel(texture, x1, y1, table);
  return (1 - ty) * top + ty * bottom;
}

}  // namespace chiaro::renderer
