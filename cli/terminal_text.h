#pragma once
// Names in files are whatever somebody wrote there, and terminals obey some of it.

#include <functional>
#include <string>
#include <string_view>

namespace chiaro::cli {

// With replacement(code point) in place of what terminals obey rather than show: control characters (C0, DEL and C1),
// separators of lines and paragraphs (U+2028, U+2029), and what turns the direction of text around (U+202A to U+202E,
// U+2066 to U+2069). `utf8` is valid.
std::string without_controls(std::string_view utf8, const std::function<std::string(char32_t)>& replacement);

}  // namespace chiaro::cli
