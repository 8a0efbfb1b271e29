#include "cli/named_file.h"

#include <filesystem>

namespace chiaro::cli {

NamedFile split_named_file(const std::string& text) {
  const auto is_file = [](const std::string& name) {
    std::error_code unknown;
    return std::filesystem::is_regular_file(name, unknown);
  };
  const std::size_t first = text.find('=');
  if (first == text.npos || is_file(text)) return {"", text};
  for (std::size_t equals = first; equals != text.npos; equals = text.find('=', equals + 1)) {
    if (is_file(text.substr(equals + 1))) return {text.substr(0, equals), text.substr(equals + 1)};
  }
  return {text.substr(0, first), text.substr(first + 1)};
}

}  // namespace chiaro::cli
