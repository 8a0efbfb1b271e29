#include "renderer/image/encoded_image.h"

#include <array>
#include <cstdint>

namespace chiaro::renderer {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

std::uint32_t byte_at(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
  return byte_at(bytes, at) << 24 | byte_at(bytes, at + 1) << 16 | byte_at(bytes, at + 2) << 8 | byte_at(bytes, at + 3);
}

std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table;
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}

// ISO/IEC 15948:2004 (PNG), annex D.
std::uint32_t crc(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> kTable = crc_table();
  std::uint32_t c = 0xFFFFFFFFU;
  for (const char byte : bytes) c = kTable[(c ^ static_cast<unsigned char>(byte)) & 0xFF] ^ (c >> 8);
  return ~c;
}

std::optional<std::string> find_png_damage(std::string_view bytes) {
  for (std::size_t at = kPngSignature.size(); bytes.size() - at >= 12;) {
    const std::size_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - 12) return "is truncated";
    const std::string_view type = bytes.substr(at + 4, 4);
    if (crc(bytes.substr(at + 4, length + 4)) != big_endian(bytes, at + 8 + length)) return "is corrupt";
    if (type == "IEND") return std::nullopt;
    at += 12 + length;
  }
  return "is truncated";
}

// Past the entropy-coded data of a scan: where the next marker begins that is not a restart.
std::size_t end_of_scan(std::string_view bytes, std::size_t at) {
  for (; at + 1 < bytes.size(); ++at) {
    const std::uint32_t code = byte_at(bytes, at + 1);
    const bool stuffed = code == 0 || code == 0xFF || (code >= 0xD0 && code <= 0xD7);
    if (byte_at(bytes, at) == 0xFF && !stuffed) return at;
  }
  return bytes.size();
}

// ITU-T T.81 (JPEG), annex B: segments up to the end of the image.
std::optional<std::string> find_jpeg_damage(std::string_view bytes) {
  constexpr std::uint32_t kStartOfScan = 0xDA, kEndOfImage = 0xD9;
  std::size_t at = 2;
  while (at + 4 <= bytes.size() || (at + 2 <= bytes.size() && byte_at(bytes, at + 1) == kEndOfImage)) {
    const std::uint32_t code = byte_at(bytes, at + 1);
    if (byte_at(bytes, at) != 0xFF) return "is corrupt";
    if (code == kEndOfImage) return std::nullopt;
    if (code == 0xFF) {  // a fill byte
      ++at;
      continue;
    }
    const std::size_t length = byte_at(bytes, at + 2) << 8 | byte_at(bytes, at + 3);
    if (length < 2) return "is corrupt";
    at += 2 + length;
    if (code == kStartOfScan) at = end_of_scan(bytes, at);
  }
  return "is truncated";
}

}  // namespace

std::optional<std::string> find_damage(std::string_view encoded) {
  if (encoded.starts_with(kPngSignature)) return find_png_damage(encoded);
  if (encoded.starts_with("\xff\xd8\xff")) return find_jpeg_damage(encoded);
  return std::nullopt;
}

bool may_hold(std::uintmax_t file_bytes, std::uintmax_t pixel_bytes) {
  constexpr std::uintmax_t kAlways = std::uintmax_t{1} << 28, kTightest = 10'000;
  return pixel_bytes <= kAlways || pixel_bytes / kTightest <= file_bytes;
}

}  // namespace chiaro::renderer
