#include "renderer/image/exr_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace chiaro::renderer {
namespace {

constexpr std::uint32_t kMagic = 20000630, kTiled = 1U << 9, kMultipart = 1U << 12;
// Libraries take memory for a tile, or for as many lines as are compressed together.
constexpr std::uint64_t kMostPixelsOfTile = 1U << 24, kMostPixelsOfLine = 1U << 20, kMostPixelsOfLines = 1U << 26;

// An attribute, and its type: of another readers would pass it, and take the colours for Rec.709's.
constexpr const char* kChromaticities = "chromaticities";

// 0 where the stream ends, which it then says.
std::uint32_t read_number(std::istream& stream) {
  std::array<unsigned char, 4> bytes{};
  stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
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

// Bytes of values that readers take at their own length, whatever the header says it is.
std::optional<std::uint32_t> fixed_size(const std::string& type) {
  constexpr std::pair<std::string_view, std::uint32_t> kSizes[] = {
      {"int", 4},      {"float", 4},       {"double", 8},    {"v2i", 8},      {"v2f", 8},           {"v2d", 16},
      {"v3i", 12},     {"v3f", 12},        {"v3d", 24},      {"box2i", 16},   {"box2f", 16},        {"m33f", 36},
      {"m33d", 72},    {"m44f", 64},       {"m44d", 128},    {"rational", 8}, {"timecode", 8},      {"keycode", 28},
      {"tiledesc", 9}, {"compression", 1}, {"lineOrder", 1}, {"envmap", 1},   {kChromaticities, 32}};
  for (const auto& [name, size] : kSizes) {
    if (type == name) return size;
  }
  return std::nullopt;
}

// Whether it ends, with an empty name, where the header says, and has pixels of whole numbers, halves or floats alone.
bool is_list_of_channels(std::istream& stream, std::uint32_t size) {
  constexpr std::uint32_t kPixelTypes = 3;
  constexpr std::streamoff kAfterType = 12;
  const auto begin = stream.tellg(), end = begin + std::streamoff(size);
  bool known = true;
  std::optional<std::string> name = read_name(stream);
  for (; name && !name->empty() && stream.tellg() < end; name = read_name(stream)) {
    known = known && read_number(stream) < kPixelTypes;
    stream.seekg(kAfterType, std::ios::cur);
  }
  const bool in_time = name && name->empty() && stream.tellg() == end;
  stream.clear();
  stream.seekg(begin);
  return known && in_time;
}

bool is_of_its_type(std::istream& stream, const std::string& type, std::uint32_t size) {
  return type == "chlist" ? is_list_of_channels(stream, size) : fixed_size(type).value_or(size) == size;
}

struct Header {
  std::optional<bool> tiled{};  // or in lines, whatever it says of tiles; absent: its type is not given
  std::uint64_t width = 0, height = 0, tile_width = 0, tile_height = 0;  // pixels
  std::uint64_t lines = 16;  // that are compressed together; where it is not said, as by ZIP
  std::set<std::string> names{};

  std::uint64_t tile() const { return tile_width * std::min<std::uint64_t>(tile_height, kMostPixelsOfTile + 1); }
};

// By the number of a compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB; the most of what comes
// later.
std::uint64_t lines_together(std::size_t compression) {
  constexpr std::array<std::uint64_t, 10> kLines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return kLines[std::min(compression, kLines.size() - 1)];
}

// Whether readers may believe the one where there are two, and what is looked at here is the other.
bool decides(std::string_view name) {
  constexpr std::string_view kDecide[] = {"type", "compression", "tiles", "dataWindow", "channels", kChromaticities};
  return std::find(std::begin(kDecide), std::end(kDecide), name) != std::end(kDecide);
}

// Values of an attribute that say how much is read at once.
void read_value(std::istream& stream, const std::string& name, std::uint32_t size, Header& header) {
  const auto end = stream.tellg() + std::streamoff(size);
  if (name == "type") {
    std::string kind(std::min<std::uint32_t>(size, 16), 0);
    stream.read(kind.data(), std::streamsize(kind.size()));
    header.tiled = kind == "tiledimage" || kind == "deeptile";
  }
  if (name == "compression" && size >= 1) header.lines = lines_together(std::size_t(stream.get()));
  if (name == "tiles" && size >= 8) {
    header.tile_width = read_number(stream), header.tile_height = read_number(stream);
  }
  if (name == "dataWindow" && size >= 16) {
    std::array<std::int64_t, 4> edges{};  // left, top, right, bottom
    for (std::int64_t& edge : edges) edge = std::int32_t(read_number(stream));
    header.width = std::uint64_t(edges[2] - edges[0] + 1), header.height = std::uint64_t(edges[3] - edges[1] + 1);
  }
  stream.seekg(end);
}

// A file has eight bytes to say where each chunk is, and readers take as many, or more, for each.
std::optional<std::string> more_chunks_than_fit(const Header& header, bool tiled, std::uint64_t file_size) {
  const auto parts = [](std::uint64_t whole, std::uint64_t part) { return whole / part + (whole % part == 0 ? 0 : 1); };
  const std::uint64_t most = file_size / sizeof(std::uint64_t);
  if (tiled && (header.tile_width == 0 || header.tile_height == 0)) return std::nullopt;  // which readers refuse
  const std::uint64_t down = parts(header.height, tiled ? header.tile_height : header.lines);
  const std::uint64_t across = tiled ? parts(header.width, header.tile_width) : 1;
  if (down == 0 || across <= most / down) return std::nullopt;
  return fmt::format("is cut short, or its header is corrupt: {} x {} {} in {} bytes", across, down,
                     tiled ? "tiles" : "blocks of lines", file_size);
}

// file_is_tiled: as the file itself says. Where that and the header differ readers may believe either.
std::optional<std::string> oversized(const Header& header, std::optional<bool> file_is_tiled, std::uint64_t file_size) {
  const bool by_type = header.tiled.value_or(file_is_tiled.value_or(false)), by_file = file_is_tiled.value_or(by_type);
  if ((by_type || by_file) && header.tile() > kMostPixelsOfTile) {
    return fmt::format("its header is corrupt: tiles of {} pixels", header.tile());
  }
  const bool in_lines = !by_type || !by_file;
  if (in_lines && (header.width > kMostPixelsOfLine || header.width * header.lines > kMostPixelsOfLines)) {
    return fmt::format("its header is corrupt: lines of {} pixels, {} at once", header.width, header.lines);
  }
  const auto of_tiles = by_type || by_file ? more_chunks_than_fit(header, true, file_size) : std::nullopt;
  return of_tiles || !in_lines ? of_tiles : more_chunks_than_fit(header, false, file_size);
}

// Passes the attributes of one part; whether there were any.
bool pass_header(std::istream& stream, std::uintmax_t file_size, std::optional<bool> file_is_tiled,
                 std::optional<std::string>& damage) {
  Header header;
  bool any = false;
  while (true) {
    const std::optional<std::string> name = read_name(stream);
    if (name && name->empty()) {
      damage = oversized(header, file_is_tiled, file_size);
      return any;
    }
    const std::optional<std::string> type = name ? read_name(stream) : std::nullopt;
    const std::uint32_t size = read_number(stream);
    if (!type || !stream) {
      damage = "its header is cut short";
    } else if (size > file_size - std::uintmax_t(stream.tellg()) || !is_of_its_type(stream, *type, size)) {
      damage = fmt::format("its header is corrupt: attribute \"{}\" of {} bytes", name->substr(0, 40), size);
    } else if (*name == kChromaticities && *type != kChromaticities) {
      damage = fmt::format("its header is corrupt: {} of type \"{}\"", kChromaticities, type->substr(0, 40));
    }
    if (!damage && !header.names.insert(*name).second && decides(*name)) {
      damage = fmt::format("its header is corrupt: attribute \"{}\" twice", *name);
    }
    if (damage) return any;
    read_value(stream, *name, size, header);
    any = true;
  }
}

struct Headers {
  std::optional<std::string> damage{};
  std::optional<std::uint64_t> end{};  // of the only one
};

Headers read_headers(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::error_code no_size;
  const std::uintmax_t size = std::filesystem::file_size(path, no_size);
  if (!stream || no_size || read_number(stream) != kMagic) return {};
  const std::uint32_t version = read_number(stream);
  const bool multipart = (version & kMultipart) != 0;
  const auto file_is_tiled = multipart ? std::nullopt : std::optional((version & kTiled) != 0);
  Headers headers;
  bool more = pass_header(stream, size, file_is_tiled, headers.damage);
  while (!headers.damage && multipart && more) more = pass_header(stream, size, file_is_tiled, headers.damage);
  if (!headers.damage && !multipart) headers.end = std::uint64_t(stream.tellg());
  return headers;
}

}  // namespace

std::optional<std::string> find_exr_header_damage(const std::filesystem::path& path) {
  return read_headers(path).damage;
}

std::optional<std::uint64_t> end_of_exr_header(const std::filesystem::path& path) {
  const Headers headers = read_headers(path);
  return headers.damage ? std::nullopt : headers.end;
}

}  // namespace chiaro::renderer
