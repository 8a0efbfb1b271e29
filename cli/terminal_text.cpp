#include "cli/terminal_text.h"

namespace chiaro::cli {
namespace {

struct CodePoint {
  char32_t code;
  std::size_t length;  // bytes
};

// The first of `utf8`, as far as it is of up to three bytes: all that is looked for is.
CodePoint first_of(std::string_view utf8) {
  const auto bits = [&](std::size_t at) { return static_cast<unsigned char>(utf8[at]) & 0x3FU; };
  const auto lead = static_cast<unsigned char>(utf8.front());
  if (lead >= 0xC0 && lead < 0xE0 && utf8.size() >= 2) return {(lead & 0x1FU) << 6 | bits(1), 2};
  if (lead >= 0xE0 && lead < 0xF0 && utf8.size() >= 3) return {(lead & 0xFU) << 12 | bits(1) << 6 | bits(2), 3};
  return {lead, 1};
}

bool is_control(CodePoint c) {
  const auto within = [&](char32_t first, char32_t last) { return c.code >= first && c.code <= last; };
  if (c.length == 1) return c.code < 0x20 || c.code == 0x7F;
  return within(0x80, 0x9F) || within(0x2028, 0x202E) || within(0x2066, 0x2069);
}

}  // namespace

std::string without_controls(std::string_view utf8, const std::function<std::string(char32_t)>& replacement) {
  std::string text;
  while (!utf8.empty()) {
    const CodePoint c = first_of(utf8);
    if (is_control(c)) {
      text += replacement(c.code);
    } else {
      text += utf8.substr(0, c.length);
    }
    utf8.remove_prefix(c.length);
  }
  return text;
}

}  // namespace chiaro::cli
