#include "renderer/image/encoded_image.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <locale>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "renderer/core/file_extension.h"
#include "renderer/image/decode_avif.h"
#include "renderer/image/decode_png.h"
#include "renderer/image/decode_webp.h"

namespace chiaro::renderer {
namespace {

std::uint32_t byte_at(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
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
  constexpr std::size_t kTypeAt = 2, kDepthAt = 16, kDescriptorAt = 17;
  if (bytes.size() <= kDescriptorAt) return "is truncated";
  const bool grey = bytes[kTypeAt] == 3 || bytes[kTypeAt] == 11;
  if (bytes[kTypeAt] == 1 || bytes[kTypeAt] == 9) return "has a palette";
  if (!grey && byte_at(bytes, kDepthAt) < 15) return fmt::format("has colours of {} bits", byte_at(bytes, kDepthAt));
  if (byte_at(bytes, kDescriptorAt) >> 6 != 0) return "has interleaved lines";
  return std::nullopt;
}

// The words of a PNM's header: its kind, width, height and, but for bits, the largest sample.
std::vector<std::string> pnm_words(std::string_view bytes) {
  std::vector<std::string> words;
  std::istringstream text{std::string(bytes)};
  text.imbue(std::locale::classic());
  for (std::string word; words.size() < 4 && text >> word;) {
    if (word.starts_with('#')) {
      std::getline(text, word);
    } else {
      words.push_back(word);
    }
  }
  return words;
}

// Poskanzer's formats as netpbm documents them, and PFM. OpenImageIO computes with samples of up to 32767 or all 16
// bits.
std::optional<std::string> damage_of_pnm(std::string_view bytes) {
  const std::vector<std::string> words = pnm_words(bytes);
  if (words.empty()) return "is truncated";
  const std::string& kind = words.front();
  if (kind == "P4") return std::nullopt;
  if (kind != "P5" && kind != "P6" && kind != "PF" && kind != "Pf") return "is not a picture of bytes (P4, P5, P6, PF)";
  if (words.size() < 4) return "is truncated";
  if (bytes.substr(kind.size()).starts_with("\r\n")) return "has line ends of two characters";
  const std::string problem = fmt::format("has samples of up to {}", words[3].substr(0, 20));
  if (kind == "PF" || kind == "Pf") {
    const std::optional<double> scale = number_of(words[3]);
    return scale && std::isnormal(float(*scale)) ? std::nullopt : std::optional(problem);
  }
  const std::optional<double> most = number_of(words[3]);
  const bool read = most && ((*most >= 1 && *most <= 32767) || *most == 65535) && *most == std::floor(*most);
  return read ? std::nullopt : std::optional(problem);
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
  if (is_avif(first_bytes)) return "avif";
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
  if (format == "pnm") return damage_of_pnm(bytes);
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
