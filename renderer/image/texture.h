#pragma once

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
};

}  // namespace chiaro::renderer
