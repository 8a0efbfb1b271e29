#include "renderer/image/exr_chunks.h"

#include <atomic>
#include <functional>

#include <openexr.h>

#include "renderer/core/control.h"

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
bool are_whole_tiles(exr_const_context_t file, std::uintmax_t file_size, int part, const exr_attr_box2i_t& window) {
  std::uint32_t width = 0, height = 0;
  exr_tile_level_mode_t levels;
  exr_tile_round_mode_t rounding;
  if (exr_get_tile_descriptor(file, part, &width, &height, &levels, &rounding) != EXR_ERR_SUCCESS) return true;
  if (width == 0 || height == 0) return true;
  const auto count = [](std::int64_t first, std::int64_t last, std::int64_t tile) {
    return std::size_t((last - first) / tile + 1);
  };
  const std::size_t across = count(window.min.x, window.max.x, width), down = count(window.min.y, window.max.y, height);
  const auto is_whole_at = [&](std::size_t i) { return is_whole_tile(file, part, int(i % across), int(i / across)); };
  return have_places(file_size, across * down) && all_of(across * down, is_whole_at);
}

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
  explicit Context(const std::filesystem::path& path) {
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

std::optional<std::string> ExrChunks::find_damage(int part) const {
  exr_const_context_t const file = context_->file;
  exr_storage_t storage;
  exr_attr_box2i_t window;
  if (file == nullptr || exr_get_storage(file, part, &storage) != EXR_ERR_SUCCESS ||
      exr_get_data_window(file, part, &window) != EXR_ERR_SUCCESS) {
    return std::nullopt;
  }
  const bool tiled = storage == EXR_STORAGE_TILED, lines = storage == EXR_STORAGE_SCANLINE;
  if (tiled && !are_whole_tiles(file, context_->bytes, part, window)) return "a tile does not hold all its pixels";
  if (lines && !are_whole_lines(file, context_->bytes, part, window)) return "lines do not hold all their pixels";
  return std::nullopt;
}

}  // namespace chiaro::renderer
