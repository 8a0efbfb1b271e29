#pragma once

#include <string>

namespace chiaro::renderer {

// The first of `text`, no more than `bytes` and whole characters of UTF-8.
inline std::string shortened(const std::string& text, std::size_t bytes) {
  const auto goes_on = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U; };
  if (text.size() <= bytes) return text;
  while (bytes > 0 && goes_on(bytes)) --bytes;
  return text.substr(0, bytes);
}

}  // namespace chiaro::renderer
