#include "renderer/image/exr_tiles.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <utility>

#include <ImathBox.h>
#include <ImathVec.h>
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>
#include <ImfThreading.h>
#include <ImfTiledInputFile.h>
#include <ImfTiledOutputFile.h>
#include <ImfVecAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/image/exr_chunks.h"
#include "renderer/image/exr_header.h"
#include "renderer/image/read_through_library.h"

namespace chiaro::renderer {
namespace {

// zlib's fastest: the tenth that it leaves is not worth twice the time.
constexpr int kZipLevel = 1;
constexpr int kMostPixelsAcross = 1 << 30;
constexpr std::size_t kPixelsAtOnce = std::size_t{1} << 21;  // that are decoded, but for larger tiles
constexpr const char* kExpected = "a tiled OpenEXR file";

[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& reason) {
  throw Error({path.string(), "", "cannot be written: " + reason, ""});
}

// OpenEXR's own stream loses errors of what it writes last.
class OutputStream : public Imf::OStream {
 public:
  explicit OutputStream(const std::filesystem::path& path)
      : OStream(path.c_str()), stream_(path, std::ios::binary | std::ios::trunc) {
    if (!stream_) fail_to_write(path, std::strerror(errno));
  }
  void write(const char bytes[], int count) override {
    errno = 0;
    stream_.write(bytes, count);
    check();
  }
  std::uint64_t tellp() override { return std::uint64_t(std::streamoff(stream_.tellp())); }
  void seekp(std::uint64_t position) override { stream_.seekp(std::streamoff(position)); }
  void flush() {
    errno = 0;
    stream_.flush();
    check();
  }
  void close() {
    errno = 0;
    stream_.close();
    check();
  }
  const std::string& problem() const { return problem_; }

 private:
  void check() {
    if (stream_) return;
    if (problem_.empty()) problem_ = errno != 0 ? std::strerror(errno) : "the disk does not take it";
    throw std::runtime_error(problem_);
  }
  std::ofstream stream_;
  std::string problem_;
};

struct InsertAttribute {
  Imf::Header& header;
  const std::string& name;
  void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
  void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
  void operator()(const std::string& value) const { header.insert(name, Imf::StringAttribute(value)); }
  void operator()(const std::array<float, 3>& v) const {
    header.insert(name, Imf::V3fAttribute(Imath::V3f(v[0], v[1], v[2])));
  }
  template <class Other>
  void operator()(const Other&) const {
    CHIARO_CHECK(!"an attribute of this kind");
  }
};

Imf::Header header_of(const ExrTiles& shape, const Attributes& attributes) {
  const Imath::Box2i display({0, 0}, {shape.width - 1, shape.height - 1});
  const Imath::Box2i data({shape.first_column, 0}, {shape.last_column - 1, shape.height - 1});
  Imf::Header header(display, data);
  for (const std::string& channel : shape.channels) header.channels().insert(channel, Imf::Channel(Imf::HALF));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kZipLevel;
  header.setTileDescription(
      Imf::TileDescription(unsigned(shape.tile_width), unsigned(shape.tile_height), Imf::ONE_LEVEL));
  for (const auto& [name, value] : attributes) std::visit(InsertAttribute{header, name}, value);
  return header;
}

Attributes attributes_of(const Imf::Header& header) {
  Attributes all;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const Imf::Attribute& a = it.attribute();
    if (const auto* i = dynamic_cast<const Imf::IntAttribute*>(&a)) all.emplace_back(it.name(), i->value());
    if (const auto* f = dynamic_cast<const Imf::FloatAttribute*>(&a)) all.emplace_back(it.name(), f->value());
    if (const auto* s = dynamic_cast<const Imf::StringAttribute*>(&a)) all.emplace_back(it.name(), s->value());
    if (const auto* v = dynamic_cast<const Imf::V3fAttribute*>(&a)) {
      all.emplace_back(it.name(), std::array<float, 3>{v->value().x, v->value().y, v->value().z});
    }
  }
  return all;
}

// Pixels or tiles [left, right) × [top, bottom).
struct Window {
  int left, right, top, bottom;

  std::size_t width() const { return std::size_t(right - left); }
  std::size_t area() const { return width() * std::size_t(bottom - top); }
};

// The tiles that these pixels are in. Both count from the picture's corner, but tiles across from the first column.
Window tiles_over(const ExrTiles& shape, const Window& pixels) {
  const int left = pixels.left - shape.first_column, right = pixels.right - shape.first_column;
  return {left / shape.tile_width, (right - 1) / shape.tile_width + 1, pixels.top / shape.tile_height,
          (pixels.bottom - 1) / shape.tile_height + 1};
}

// All that these tiles have: the last ones may be smaller.
Window pixels_of(const ExrTiles& shape, const Window& tiles) {
  const auto end = [](int first, int tile, int size, int last) {
    return int(std::min(std::int64_t{first} + std::int64_t{tile} * size, std::int64_t{last}));
  };
  return {shape.first_column + tiles.left * shape.tile_width,
          end(shape.first_column, tiles.right, shape.tile_width, shape.last_column), tiles.top * shape.tile_height,
          end(0, tiles.bottom, shape.tile_height, shape.height)};
}

struct TileCount {
  int across, down;
};

// As many of these as may be decoded at once.
TileCount tiles_at_once(const ExrTiles& shape, const Window& tiles) {
  const std::size_t width = std::size_t(std::min(shape.tile_width, shape.last_column - shape.first_column));
  const std::size_t tile = width * std::size_t(std::min(shape.tile_height, shape.height));
  const auto count = [](std::size_t fitting, int there) {
    return std::clamp(fitting, std::size_t{1}, std::size_t(there));
  };
  const std::size_t across = count(kPixelsAtOnce / tile, tiles.right - tiles.left);
  return {int(across), int(count(kPixelsAtOnce / tile / across, tiles.bottom - tiles.top))};
}

// What two windows share, from the one to the other.
void copy_shared(const std::vector<half>& from, const Window& there, std::span<float> to, const Window& wanted,
                 std::size_t channels) {
  const int left = std::max(there.left, wanted.left), right = std::min(there.right, wanted.right);
  const int top = std::max(there.top, wanted.top), bottom = std::min(there.bottom, wanted.bottom);
  const auto offset = [&](const Window& window, int y) {
    return std::ptrdiff_t((std::size_t(y - window.top) * window.width() + std::size_t(left - window.left)) * channels);
  };
  for (int y = top; y < bottom; ++y) {
    std::copy_n(from.begin() + offset(there, y), std::size_t(right - left) * channels, to.begin() + offset(wanted, y));
  }
}

// Of columns [first, …) from `top` on, in a buffer of `columns` a row.
Imf::FrameBuffer frame_buffer(const ExrTiles& shape, half* pixels, int first, int columns, int top) {
  const std::size_t pixel = shape.channels.size() * sizeof(half), row = pixel * std::size_t(columns);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < shape.channels.size(); ++c) {
    // OpenEXR counts from the picture's corner, which lies outside the buffer.
    const auto base =
        reinterpret_cast<std::uintptr_t>(pixels + c) - std::uintptr_t(first) * pixel - std::uintptr_t(top) * row;
    buffer.insert(shape.channels[c], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(base), pixel, row));
  }
  return buffer;
}

// Lines of channel after channel into pixels.
void interleave(const char* lines, const Window& from, const Window& to, std::size_t channels, half* pixels) {
  static_assert(std::endian::native == std::endian::little, "as OpenEXR stores samples");
  for (int y = from.top; y < from.bottom; ++y) {
    half* const line = pixels + (std::size_t(y - to.top) * to.width() + std::size_t(from.left - to.left)) * channels;
    for (std::size_t c = 0; c < channels; ++c, lines += from.width() * sizeof(half)) {
      for (std::size_t x = 0; x < from.width(); ++x)
        std::memcpy(&line[x * channels + c], lines + x * sizeof(half), sizeof(half));
    }
  }
}

half to_half(float value) { return half(std::clamp(value, -float(HALF_MAX), float(HALF_MAX))); }

}  // namespace

struct ExrTileWriter::File {
  File(const std::filesystem::path& path, const Imf::Header& header)
      : stream(path), output(std::make_unique<Imf::TiledOutputFile>(stream, header, thread_count())) {}
  OutputStream stream;
  std::unique_ptr<Imf::TiledOutputFile> output;
};

ExrTileWriter::ExrTileWriter(const std::filesystem::path& path, const ExrTiles& shape, const Attributes& attributes)
    : path_(path), shape_(shape) {
  Imf::setGlobalThreadCount(thread_count());
  try {
    file_ = std::make_unique<File>(path, header_of(shape, attributes));
    file_->stream.flush();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail_to_write(path, error.what());
  }
}

ExrTileWriter::~ExrTileWriter() = default;

void ExrTileWriter::write(int tile_row, int first, int last, std::span<const float> pixels) {
  CHIARO_CHECK(file_ != nullptr);
  const std::size_t size = std::size_t(last - first) * shape_.rows_of(tile_row) * shape_.channels.size();
  CHIARO_CHECK(pixels.size() == size);
  std::vector<half> halves(size);
  std::transform(pixels.begin(), pixels.end(), halves.begin(), to_half);
  const int left = first - shape_.first_column, right = last - shape_.first_column;
  CHIARO_CHECK(left >= 0 && left % shape_.tile_width == 0);
  CHIARO_CHECK(last == shape_.last_column || (last < shape_.last_column && right % shape_.tile_width == 0));
  try {
    file_->output->setFrameBuffer(
        frame_buffer(shape_, halves.data(), first, last - first, tile_row * shape_.tile_height));
    file_->output->writeTiles(left / shape_.tile_width, (right - 1) / shape_.tile_width, tile_row, tile_row);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail_to_write(path_, file_->stream.problem().empty() ? error.what() : file_->stream.problem());
  }
}

void ExrTileWriter::flush() {
  CHIARO_CHECK(file_ != nullptr);
  try {
    file_->stream.flush();
  } catch (const std::exception& error) {
    fail_to_write(path_, error.what());
  }
}

void ExrTileWriter::close() {
  CHIARO_CHECK(file_ != nullptr);
  file_->output.reset();  // writes where the tiles are, and keeps errors to itself
  try {
    if (file_->stream.problem().empty()) file_->stream.close();
  } catch (const std::exception&) {
  }
  const std::string problem = file_->stream.problem();
  file_.reset();
  if (!problem.empty()) fail_to_write(path_, problem);
}

struct ExrTileReader::File {
  explicit File(const std::filesystem::path& path) : input(path.c_str(), thread_count()), chunks(path) {
    if (input.isComplete()) return;
    found.emplace();
    for (const ExrTilePlace& place : chunks.find_tiles()) found->emplace(std::pair(place.x, place.y), place);
  }

  // Whole tiles, one chunk each; `window`: their pixels. False where any is missing or damaged.
  bool decode(const ExrTiles& shape, const Window& tiles, const Window& window, half* pixels) const {
    std::atomic<bool> whole = true;
    parallel_for(tiles.area(), [&](std::size_t i) {
      const int x = tiles.left + int(i % tiles.width()), y = tiles.top + int(i / tiles.width());
      const Window of_tile = pixels_of(shape, {x, x + 1, y, y + 1});
      const std::vector<char> bytes = whole ? read_tile(x, y) : std::vector<char>{};
      if (bytes.size() != of_tile.area() * shape.channels.size() * sizeof(half)) {
        whole = false;
      } else {
        interleave(bytes.data(), of_tile, window, shape.channels.size(), pixels);
      }
    });
    return whole;
  }

  std::vector<char> read_tile(int x, int y) const {
    if (!found) return chunks.read_tile(x, y);
    const auto place = found->find({x, y});
    return place == found->end() ? std::vector<char>{} : chunks.read_tile(place->second);
  }

  Imf::TiledInputFile input;
  ExrChunks chunks;
  std::optional<std::map<std::pair<int, int>, ExrTilePlace>> found;  // in a file that was not finished
};

bool ExrTileReader::is_tiled(const std::filesystem::path& path) {
  std::error_code ignored;
  bool tiled = false;
  return std::filesystem::is_regular_file(path, ignored) && Imf::isOpenExrFile(path.c_str(), tiled) && tiled;
}

ExrTileReader::ExrTileReader(const std::filesystem::path& path) : path_(path) {
  require_file(path, kExpected);
  Imf::setGlobalThreadCount(thread_count());
  if (const auto damage = find_exr_header_damage(path)) throw Error({path.string(), "", *damage, "a whole file"});
  try {
    file_ = std::make_unique<File>(path);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error({path.string(), "header", fmt::format("cannot be read: {}", error.what()), kExpected});
  }
  const Imf::Header& header = file_->input.header();
  const Imath::Box2i display = header.displayWindow(), data = header.dataWindow();
  bool sensible = display.min == Imath::V2i(0, 0) && data.min.y == 0 && data.max.y == display.max.y &&
                  data.min.x >= 0 && data.max.x <= display.max.x && display.max.x < kMostPixelsAcross &&
                  display.max.y < kMostPixelsAcross && header.tileDescription().mode == Imf::ONE_LEVEL;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    sensible = sensible && it.channel().type == Imf::HALF && it.channel().xSampling == 1 && it.channel().ySampling == 1;
    shape_.channels.emplace_back(it.name());
  }
  if (!sensible || shape_.channels.empty()) {
    throw Error({path.string(), "header", "windows, channels or tiles of another kind",
                 "half channels, one level of tiles, and windows that begin at 0, 0"});
  }
  shape_.width = display.max.x + 1, shape_.height = display.max.y + 1;
  shape_.first_column = data.min.x, shape_.last_column = data.max.x + 1;
  shape_.tile_width = int(header.tileDescription().xSize), shape_.tile_height = int(header.tileDescription().ySize);
  attributes_ = attributes_of(header);
}

ExrTileReader::~ExrTileReader() = default;

bool ExrTileReader::read(int top, int bottom, int first, int last, std::span<float> pixels) {
  const Window wanted{first, last, top, bottom};
  const bool across = shape_.first_column <= first && first < last && last <= shape_.last_column;
  if (!across || top < 0 || top >= bottom || bottom > shape_.height) return false;
  CHIARO_CHECK(pixels.size() == wanted.area() * shape_.channels.size());
  const Window tiles = tiles_over(shape_, wanted);
  const TileCount step = tiles_at_once(shape_, tiles);
  std::vector<half> halves;
  for (int y = tiles.top; y < tiles.bottom; y += step.down) {
    for (int x = tiles.left; x < tiles.right; x += step.across) {
      const Window some{x, std::min(x + step.across, tiles.right), y, std::min(y + step.down, tiles.bottom)};
      const Window decoded = pixels_of(shape_, some);
      halves.resize(decoded.area() * shape_.channels.size());
      if (!file_->decode(shape_, some, decoded, halves.data())) return false;
      copy_shared(halves, decoded, pixels, wanted, shape_.channels.size());
    }
  }
  return true;
}

}  // namespace chiaro::renderer
