#include "renderer/image/exr_chunks.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <fstream>
#include <functional>

#include <openexr.h>

#include "renderer/core/control.h"
#include "renderer/image/exr_header.h"

namespace chiaro::renderer {
namespace {

void say_nothing(exr_const_context_t, exr_result_t, const char*) {}

// Decoders of the others find out for themselves.
bool may_be_short(std::uint8_t compression) {
  return compression == EXR_COMPRESSION_NONE || compression == EXR_COMPRESSION_RLE ||
         compression == EXR_COMPRESSION_ZIPS || compression == EXR_COMPRESSION_ZIP;
}

// One chunk, unpacked; what does not become smaller is stored as it is.
class Unpacked {
 public:
  Unpacked(exr_const_context_t file, int part, const exr_chunk_info_t& chunk)
      : file_(file), size_(chunk.unpacked_size) {
    if (chunk.compression == EXR_COMPRESSION_NONE && chunk.packed_size != chunk.unpacked_size) return;
    whole_ = exr_decoding_initialize(file, part, &chunk, &decoding_) == EXR_ERR_SUCCESS &&
             exr_decoding_choose_default_routines(file, part, &decoding_) == EXR_ERR_SUCCESS;
    decoding_.unpack_and_convert_fn = nullptr;
    whole_ = whole_ && exr_decoding_run(file, part, &decoding_) == EXR_ERR_SUCCESS;
  }
  ~Unpacked() { exr_decoding_destroy(file_, &decoding_); }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  bool is_whole() const { return whole_; }
  std::vector<char> bytes() const {
    const auto* first = static_cast<const char*>(decoding_.unpacked_buffer);
    return whole_ && first != nullptr ? std::vector<char>(first, first + size_) : std::vector<char>{};
  }

 private:
  exr_const_context_t file_;
  std::size_t size_;
  exr_decode_pipeline_t decoding_{};
  bool whole_ = false;
};

bool is_whole(exr_const_context_t file, int part, const exr_chunk_info_t& chunk) {
  return !may_be_short(chunk.compression) || Unpacked(file, part, chunk).is_whole();
}

bool is_whole_tile(exr_const_context_t file, int part, int x, int y) {
  exr_chunk_info_t chunk;
  return exr_read_tile_chunk_info(file, part, x, y, 0, 0, &chunk) == EXR_ERR_SUCCESS && is_whole(file, part, chunk);
}

bool all_of(std::size_t count, const std::function<bool(std::size_t)>& holds) {
  std::atomic<bool> all = true;
  parallel_for(count, [&](std::size_t i) {
    if (all && !holds(i)) all = false;
  });
  return all;
}

// A file says in eight bytes where each chunk begins.
bool have_places(std::uintmax_t file_size, std::size_t chunks) { return chunks <= file_size / sizeof(std::uint64_t); }

// Of the finest level.
struct Tiles {
  std::int64_t width = 0, height = 0;  // of one
  std::size_t across = 0, down = 0;
  exr_attr_box2i_t window{};

  std::size_t count() const { return across * down; }
};

// None where the part has no tiles.
Tiles tiles_of(exr_const_context_t file, int part) {
  Tiles tiles;
  std::uint32_t width = 0, height = 0;
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  if (exr_get_tile_descriptor(file, part, &width, &height, &levels, &rounding) != EXR_ERR_SUCCESS) return {};
  if (width == 0 || height == 0 || exr_get_data_window(file, part, &tiles.window) != EXR_ERR_SUCCESS) return {};
  const auto count = [](std::int64_t first, std::int64_t last, std::int64_t tile) {
    return std::size_t((last - first) / tile + 1);
  };
  tiles.width = width, tiles.height = height;
  tiles.across = count(tiles.window.min.x, tiles.window.max.x, width);
  tiles.down = count(tiles.window.min.y, tiles.window.max.y, height);
  return tiles;
}

bool are_whole_tiles(exr_const_context_t file, std::uintmax_t file_size, int part) {
  const Tiles tiles = tiles_of(file, part);
  const auto is_whole_at = [&](std::size_t i) {
    return is_whole_tile(file, part, int(i % tiles.across), int(i / tiles.across));
  };
  return have_places(file_size, tiles.count()) && all_of(tiles.count(), is_whole_at);
}

// A tile of the first part, wherever it is.
exr_chunk_info_t chunk_of(exr_const_context_t file, const ExrTilePlace& place) {
  const Tiles tiles = tiles_of(file, 0);
  const auto size = [](std::int64_t first, std::int64_t last, std::int64_t tile, std::int64_t index) {
    return std::int32_t(std::min(tile, last + 1 - (first + tile * index)));
  };
  exr_chunk_info_t chunk{};
  chunk.idx = int(std::size_t(place.y) * tiles.across) + place.x;
  chunk.start_x = place.x, chunk.start_y = place.y;
  chunk.width = size(tiles.window.min.x, tiles.window.max.x, tiles.width, place.x);
  chunk.height = size(tiles.window.min.y, tiles.window.max.y, tiles.height, place.y);
  chunk.type = EXR_STORAGE_TILED;
  exr_compression_t compression;
  std::uint64_t of_whole_tile = 0;
  exr_get_compression(file, 0, &compression);
  exr_get_chunk_unpacked_size(file, 0, &of_whole_tile);
  chunk.compression = std::uint8_t(compression);
  chunk.data_offset = place.begin;
  chunk.packed_size = place.bytes;
  const std::uint64_t pixel = of_whole_tile / std::uint64_t(tiles.width * tiles.height);
  chunk.unpacked_size = pixel * std::uint64_t(chunk.width) * std::uint64_t(chunk.height);
  return chunk;
}

// OpenEXR File Layout, section "Tiles": its numbers, those of its level, and its size, of four bytes each.
static_assert(std::endian::native == std::endian::little, "as OpenEXR stores numbers");
struct TileBegin {
  std::int32_t x, y, level_x, level_y, bytes;
};

bool are_whole_lines(exr_const_context_t file, std::uintmax_t file_size, int part, const exr_attr_box2i_t& window) {
  std::int32_t at_once = 0;
  if (exr_get_scanlines_per_chunk(file, part, &at_once) != EXR_ERR_SUCCESS || at_once < 1) return true;
  const std::int64_t first = window.min.y;
  const auto count = std::size_t((window.max.y - first) / at_once + 1);
  const auto is_whole_at = [&](std::size_t i) {
    exr_chunk_info_t chunk;
    const int y = int(first + std::int64_t(i) * at_once);
    return exr_read_scanline_chunk_info(file, part, y, &chunk) == EXR_ERR_SUCCESS && is_whole(file, part, chunk);
  };
  return have_places(file_size, count) && all_of(count, is_whole_at);
}

}  // namespace

struct ExrChunks::Context {
  explicit Context(const std::filesystem::path& file_path) : path(file_path) {
    std::error_code no_size;
    bytes = std::filesystem::file_size(path, no_size);
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = say_nothing;
    if (exr_start_read(&file, path.c_str(), &settings) != EXR_ERR_SUCCESS) file = nullptr;
  }
  ~Context() {
    if (file != nullptr) exr_finish(&file);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  std::filesystem::path path;
  exr_context_t file = nullptr;
  std::uintmax_t bytes = 0;
};

ExrChunks::ExrChunks(const std::filesystem::path& path) : context_(std::make_unique<Context>(path)) {}
ExrChunks::~ExrChunks() = default;

std::vector<char> ExrChunks::read_tile(int x, int y) const {
  exr_const_context_t const file = context_->file;
  exr_chunk_info_t chunk;
  if (file == nullptr || exr_read_tile_chunk_info(file, 0, x, y, 0, 0, &chunk) != EXR_ERR_SUCCESS) return {};
  return Unpacked(file, 0, chunk).bytes();
}

int ExrChunks::count() const {
  std::int32_t chunks = 0;
  const bool known = context_->file != nullptr && exr_get_chunk_count(context_->file, 0, &chunks) == EXR_ERR_SUCCESS;
  return known ? std::max(0, chunks) : 0;
}

bool ExrChunks::has_table() const {
  const std::optional<std::uint64_t> begin = end_of_exr_header(context_->path);
  return !begin || have_places(context_->bytes - *begin, std::size_t(count()));
}

std::vector<ExrTilePlace> ExrChunks::find_tiles() const {
  const std::optional<std::uint64_t> table = end_of_exr_header(context_->path);
  const Tiles tiles = tiles_of(context_->file, 0);
  if (!table || tiles.count() == 0 || !have_places(context_->bytes - *table, tiles.count())) return {};
  std::uint64_t at = *table + sizeof(std::uint64_t) * tiles.count();
  std::ifstream stream(context_->path, std::ios::binary);
  std::vector<bool> found(tiles.count());
  std::vector<ExrTilePlace> places;
  for (TileBegin tile{}; stream.seekg(std::streamoff(at)); at += std::uint64_t(tile.bytes)) {
    if (!stream.read(reinterpret_cast<char*>(&tile), sizeof tile)) break;
    at += sizeof tile;
    const bool is_one = tile.x >= 0 && std::size_t(tile.x) < tiles.across && tile.y >= 0 &&
                        std::size_t(tile.y) < tiles.down && tile.level_x == 0 && tile.level_y == 0;
    if (!is_one || tile.bytes <= 0 || at > context_->bytes || std::uint64_t(tile.bytes) > context_->bytes - at) break;
    auto is_found = found[std::size_t(tile.y) * tiles.across + std::size_t(tile.x)];
    if (is_found) break;
    is_found = true;
    places.push_back({tile.x, tile.y, at, std::uint32_t(tile.bytes)});
  }
  if (places.empty()) return {};
  const exr_chunk_info_t last = chunk_of(context_->file, places.back());
  if (last.packed_size == last.unpacked_size) places.pop_back();
  return places;
}

std::vector<char> ExrChunks::read_tile(const ExrTilePlace& place) const {
  return Unpacked(context_->file, 0, chunk_of(context_->file, place)).bytes();
}

std::optional<std::string> ExrChunks::find_damage(int part) const {
  exr_const_context_t const file = context_->file;
  exr_storage_t storage;
  exr_attr_box2i_t window;
  if (file == nullptr || exr_get_storage(file, part, &storage) != EXR_ERR_SUCCESS ||
      exr_get_data_window(file, part, &window) != EXR_ERR_SUCCESS) {
    return std::nullopt;
  }
  const bool tiled = storage == EXR_STORAGE_TILED, lines = storage == EXR_STORAGE_SCANLINE;
  if (tiled && !are_whole_tiles(file, context_->bytes, part)) return "a tile does not hold all its pixels";
  if (lines && !are_whole_lines(file, context_->bytes, part, window)) return "lines do not hold all their pixels";
  return std::nullopt;
}

}  // namespace chiaro::renderer
