#pragma once

#include <string>

namespace chiaro::renderer {

// Of what a library says, the line that goes into a message.
inline std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.empty() ? "no reason is given" : line;
}

}  // namespace chiaro::renderer
