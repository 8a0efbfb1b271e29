#include "renderer/image/encoded_image.h"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "renderer/core/file_extension.h"
#include "renderer/image/decode_heif.h"
#include "renderer/image/decode_png.h"
#include "renderer/image/decode_webp.h"

namespace chiaro::renderer {
namespace {

std::uint32_t byte_at(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

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
std::optional<std::string> damage_of_jpeg(std::string_view bytes) {
  constexpr std::uint32_t kStartOfScan = 0xDA, kEndOfImage = 0xD9;
  if (format_of(bytes) != "jpeg") return "is not a JPEG";
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

// Truevision, TGA File Format Specification 2.0: images of types 1 and 9 are indices.
std::optional<std::string> damage_of_tga(std::string_view bytes) {
  constexpr std::size_t kTypeAt = 2, kDepthAt = 16;
  if (bytes.size() < kFormatBytes) return "is truncated";
  const bool grey = bytes[kTypeAt] == 3 || bytes[kTypeAt] == 11;
  if (bytes[kTypeAt] == 1 || bytes[kTypeAt] == 9) return "has a palette";
  if (!grey && byte_at(bytes, kDepthAt) < 15) return fmt::format("has colours of {} bits", byte_at(bytes, kDepthAt));
  return std::nullopt;
}

struct Signature {
  std::string_view format, bytes;
};

constexpr Signature kSignatures[] = {
    {"openexr", "\x76\x2f\x31\x01"},           {"jpeg", "\xff\xd8\xff"},
    {"tiff", std::string_view("II\x2a\0", 4)}, {"tiff", std::string_view("MM\0\x2a", 4)},
    {"tiff", std::string_view("II\x2b\0", 4)},  // BigTIFF
    {"tiff", std::string_view("MM\0\x2b", 4)}, {"hdr", "#?"},
};

constexpr std::pair<std::string_view, std::string_view> kExtensions[] = {
    {".exr", "openexr"}, {".png", "png"}, {".jpg", "jpeg"},  {".jpeg", "jpeg"}, {".tif", "tiff"},
    {".tiff", "tiff"},   {".hdr", "hdr"}, {".webp", "webp"}, {".tga", "targa"}, {".ppm", "pnm"},
    {".pgm", "pnm"},     {".pfm", "pnm"}, {".pnm", "pnm"},   {".pbm", "pnm"},
};

}  // namespace

std::string_view format_of(std::string_view first_bytes, const std::filesystem::path& name) {
  if (is_png(first_bytes)) return "png";
  if (is_webp(first_bytes)) return "webp";
  if (is_heif(first_bytes)) return "heif";
  for (const Signature& signature : kSignatures) {
    if (first_bytes.starts_with(signature.bytes)) return signature.format;
  }
  for (const auto& [extension, format] : kExtensions) {
    if (has_extension(name, {std::string(extension)})) return format;
  }
  return "";
}

std::optional<std::string> find_damage(std::string_view format, std::string_view bytes) {
  if (format == "jpeg") return damage_of_jpeg(bytes);
  if (format == "targa") return damage_of_tga(bytes);
  return std::nullopt;
}

bool tells_damage(std::string_view format, std::string_view message) {
  const auto says = [&](std::string_view words) { return message.find(words) != std::string_view::npos; };
  return !message.empty() && (format != "jpeg" || says("Corrupt JPEG data") || says("Premature end"));
}

bool may_hold(std::uintmax_t file_bytes, std::uintmax_t pixel_bytes) {
  constexpr std::uintmax_t kAlways = std::uintmax_t{1} << 28, kTightest = 10'000;
  return pixel_bytes <= kAlways || pixel_bytes / kTightest <= file_bytes;
}

}  // namespace chiaro::renderer
