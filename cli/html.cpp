#include "cli/html.h"

#include <algorithm>
#include <cstdint>

namespace chiaro::cli {
namespace {

// Base64 digits of three bytes, of which the first `count` are there.
void append_digits(std::string& text, const unsigned char* bytes, std::size_t count) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 3; ++i) bits = bits << 8 | (i < count ? bytes[i] : 0U);
  for (std::size_t i = 0; i < 4; ++i) text += i <= count ? kDigits[bits >> (18 - 6 * i) & 63] : '=';
}

std::string escaped(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      break;
  }
  const bool control = (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
  return control ? "\xEF\xBF\xBD" : std::string(1, c);
}

}  // namespace

std::string html_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) result += escaped(c);
  return result;
}

std::string png_data_uri(std::string_view png) {
  std::string text = "data:image/png;base64,";
  text.reserve(text.size() + (png.size() + 2) / 3 * 4);
  const auto* bytes = reinterpret_cast<const unsigned char*>(png.data());
  for (std::size_t i = 0; i < png.size(); i += 3)
    append_digits(text, bytes + i, std::min<std::size_t>(3, png.size() - i));
  return text;
}

}  // namespace chiaro::cli
