#pragma once

#include <string>

namespace chiaro::renderer {

// Of what a library says, the line that goes into a message.
inline std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace chiaro::renderer
