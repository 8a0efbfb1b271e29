#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace chiaro::renderer {

enum class Wrap : std::uint8_t { kRepeat, kMirroredRepeat, kClampToEdge };

// An 8-bit RGBA texture, rows from the top, texel (0, 0) first, as glTF's UV origin has it.
struct Texture {
  std::string name;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height
  bool nearest = false;            // magnification filter
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool filtered_as_stored = false;                // sRGB values are blended as they are stored, and decoded afterwards
  std::vector<std::vector<std::uint8_t>> mips{};  // RGBA of levels 1, 2, …; empty: none are made (mip_maps.h)
};

struct MipLevel {
  int width = 0, height = 0;
  const std::uint8_t* texels = nullptr;  // RGBA
};

// The level, or the smallest there is. Level 0 is the texture itself.
inline MipLevel mip_level(const Texture& texture, int level) {
  if (level <= 0 || texture.mips.empty()) return {texture.width, texture.height, texture.rgba.data()};
  const int k = std::min(level, int(texture.mips.size()));
  return {std::max(1, texture.width >> k), std::max(1, texture.height >> k), texture.mips[k - 1].data()};
}

}  // namespace chiaro::renderer
