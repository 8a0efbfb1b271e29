#include "renderer/image/exr_header.h"

#include <array>
#include <cstdint>
#include <fstream>

#include <fmt/format.h>

namespace chiaro::renderer {
namespace {

constexpr std::uint32_t kMagic = 20000630, kMultipart = 1U << 12;

std::optional<std::uint32_t> read_number(std::istream& stream) {
  std::array<unsigned char, 4> bytes{};
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size())) return std::nullopt;
  return bytes[0] | std::uint32_t(bytes[1]) << 8 | std::uint32_t(bytes[2]) << 16 | std::uint32_t(bytes[3]) << 24;
}

// Up to a zero.
std::optional<std::string> read_name(std::istream& stream) {
  constexpr std::size_t kLongest = 255;
  std::string name;
  for (char c = 0; stream.get(c) && name.size() <= kLongest; name.push_back(c)) {
    if (c == 0) return name;
  }
  return std::nullopt;
}

// Passes the attributes of one part; whether there were any.
bool pass_header(std::istream& stream, std::uintmax_t file_size, std::optional<std::string>& damage) {
  bool any = false;
  while (true) {
    const std::optional<std::string> name = read_name(stream);
    if (name && name->empty()) return any;
    const std::optional<std::string> type = name ? read_name(stream) : std::nullopt;
    const std::optional<std::uint32_t> size = type ? read_number(stream) : std::nullopt;
    if (!size) {
      damage = "its header is cut short";
    } else if (*size > file_size - std::uintmax_t(stream.tellg())) {
      damage = fmt::format("its header is corrupt: attribute \"{}\" of {} bytes", name->substr(0, 40), *size);
    }
    if (damage) return any;
    stream.seekg(*size, std::ios::cur);
    any = true;
  }
}

}  // namespace

std::optional<std::string> find_exr_header_damage(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::error_code no_size;
  const std::uintmax_t size = std::filesystem::file_size(path, no_size);
  if (!stream || no_size || read_number(stream) != kMagic) return std::nullopt;
  const std::optional<std::uint32_t> version = read_number(stream);
  std::optional<std::string> damage;
  bool more = pass_header(stream, size, damage);
  const bool multipart = version && (*version & kMultipart) != 0;
  while (!damage && multipart && more) more = pass_header(stream, size, damage);
  return damage;
}

}  // namespace chiaro::renderer
