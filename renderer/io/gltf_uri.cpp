#include "renderer/io/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/shortened.h"

namespace chiaro::renderer {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size();
    const int high = escape ? hex_digit(text[i + 1]) : -1, low = escape ? hex_digit(text[i + 2]) : -1;
    decoded.push_back(high < 0 || low < 0 ? text[i] : char(16 * high + low));
    if (high >= 0 && low >= 0) i += 2;
  }
  return decoded;
}

std::array<std::int8_t, 256> base64_values() {
  std::array<std::int8_t, 256> values;
  values.fill(-1);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) values[static_cast<unsigned char>(kAlphabet[i])] = std::int8_t(i);
  values['-'] = 62;  // the URL-safe alphabet's
  values['_'] = 63;
  return values;
}

// Absent where a character is not of the alphabet, or the length cannot be.
std::optional<std::string> base64_decoded(std::string_view text) {
  static const std::array<std::int8_t, 256> kValues = base64_values();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string decoded;
  decoded.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = kValues[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    bits = bits << 6 | std::uint32_t(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    decoded.push_back(char(bits >> count & 0xFF));
  }
  return decoded;
}

std::string base64_encoded(std::string_view bytes) {
  std::string encoded;
  encoded.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : std::uint32_t{0});
    }
    for (std::size_t k = 0; k < 4; ++k) encoded.push_back(k <= count ? kAlphabet[bits >> (18 - 6 * k) & 63] : '=');
  }
  return encoded;
}

std::string read_data_uri(const std::string& uri, const std::string& file, const std::string& place) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) throw Error({file, place, "a data URI without data", "data:…;base64,…"});
  const std::string_view header(uri.data(), comma), data(uri.data() + comma + 1, uri.size() - comma - 1);
  if (!in_lower_case(header).ends_with(";base64")) return percent_decoded(data);
  std::optional<std::string> decoded =
      base64_decoded(data.find('%') == std::string_view::npos ? std::string(data) : percent_decoded(data));
  if (!decoded) throw Error({file, place, "a data URI that is not base64", "base64"});
  return *std::move(decoded);
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find("://");
  return colon != std::string_view::npos && colon > 0;
}

std::optional<std::filesystem::path> find_file(const std::string& uri, const std::filesystem::path& folder) {
  for (const std::string& name : file_names_of(uri)) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(folder / name, ignored)) return folder / name;
  }
  return std::nullopt;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return in_lower_case(uri.substr(0, 5)) == "data:"; }

std::vector<std::string> file_names_of(const std::string& uri) {
  std::vector<std::string> names{percent_decoded(uri), uri};
  std::erase_if(names, [](const std::string& name) { return name.find('\0') != std::string::npos; });
  return names;
}

std::string make_data_uri(std::string_view mime_type, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", mime_type, base64_encoded(bytes));
}

std::string read_uri(const std::string& uri, const UriBase& base, const std::string& place) {
  const std::string gltf = base.gltf.string(), name = shortened(uri, 200);
  if (is_data_uri(uri)) return read_data_uri(uri, gltf, place);
  if (has_scheme(uri)) throw Error({gltf, place, fmt::format("\"{}\" is not fetched", name), "a file beside it"});
  const auto file = find_file(uri, base.gltf.parent_path());
  if (!file) throw Error({gltf, place, fmt::format("no such file: \"{}\"", name), "a file beside it"});
  if (base.external == ExternalFiles::kInFolder && !is_in_folder(*file, base.gltf.parent_path())) {
    throw Error({gltf, place, fmt::format("\"{}\" is outside its folder", name),
                 "a file beside it (--allow-external lets scenes open any)"});
  }
  return read_file(*file, std::numeric_limits<std::uintmax_t>::max());
}

}  // namespace chiaro::renderer
