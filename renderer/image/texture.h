#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace chiaro::renderer {

enum class Wrap : std::uint8_t { kRepeat, kMirroredRepeat, kClampToEdge };

// An RGBA texture of 8 or 16 bits per channel, rows from the top, texel (0, 0) first, as glTF's UV origin has it.
struct Texture {
  std::string name;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height; empty: they are in wide_rgba
  bool nearest = false;            // magnification filter
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool filtered_as_stored = false;                // sRGB values are blended as they are stored, and decoded afterwards
  std::vector<std::vector<std::uint8_t>> mips{};  // RGBA of levels 1, 2, …; empty: none are made (mip_maps.h)
  std::vector<std::uint16_t> wide_rgba{};         // in place of rgba where 8 bits do not hold what the file has
  std::vector<std::vector<std::uint16_t>> wide_mips{};
};

inline bool is_wide(const Texture& texture) { return !texture.wide_rgba.empty(); }

// The texels of a texture whose channels are such, std::uint8_t or std::uint16_t, and its levels.
template <class Channel, class AnyTexture>
auto& rgba_of(AnyTexture& texture) {
  if constexpr (sizeof(Channel) == 1) {
    return texture.rgba;
  } else {
    return texture.wide_rgba;
  }
}
template <class Channel, class AnyTexture>
auto& mips_of(AnyTexture& texture) {
  if constexpr (sizeof(Channel) == 1) {
    return texture.mips;
  } else {
    return texture.wide_mips;
  }
}

inline bool has_mips(const Texture& texture) { return !texture.mips.empty() || !texture.wide_mips.empty(); }

template <class Channel>
struct MipLevelOf {
  int width = 0, height = 0;
  const Channel* texels = nullptr;  // RGBA
};
using MipLevel = MipLevelOf<std::uint8_t>;

// The level, or the smallest there is. Level 0 is the texture itself.
template <class Channel = std::uint8_t>
MipLevelOf<Channel> mip_level(const Texture& texture, int level) {
  const auto& mips = mips_of<Channel>(texture);
  if (level <= 0 || mips.empty()) return {texture.width, texture.height, rgba_of<Channel>(texture).data()};
  const int k = std::min(level, int(mips.size()));
  return {std::max(1, texture.width >> k), std::max(1, texture.height >> k), mips[k - 1].data()};
}

}  // namespace chiaro::renderer
