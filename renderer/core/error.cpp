#include "renderer/core/error.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace chiaro::renderer {

std::string Error::format(const Parts& parts) {
  std::string text;
  for (const std::string* part : {&parts.file, &parts.place, &parts.problem}) {
    if (part->empty()) continue;
    if (!text.empty()) text += ": ";
    text += *part;
  }
  if (!parts.expected.empty()) text += " (expected " + parts.expected + ")";
  std::replace(text.begin(), text.end(), '\0', ' ');  // what() ends there, and names in files may have one
  return text;
}

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "chiaro: internal error: %s:%d: %s does not hold\n", file, line, condition);
  std::abort();
}

}  // namespace chiaro::renderer
