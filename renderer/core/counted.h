#pragma once

#include <cstdint>
#include <string>

namespace chiaro::renderer {

// "1 pixel is", "3 pixels are".
inline std::string counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace chiaro::renderer
