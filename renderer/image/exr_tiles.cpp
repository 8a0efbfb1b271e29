#include "renderer/image/exr_tiles.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

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
#include "renderer/image/exr_header.h"
#include "renderer/image/read_through_library.h"

namespace chiaro::renderer {
namespace {

// zlib's fastest: the tenth that it leaves is not worth twice the time.
constexpr int kZipLevel = 1;
constexpr int kMostPixelsAcross = 1 << 30;
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
  } catch (const Error&) {
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
  try {
    file_->output->setFrameBuffer(
        frame_buffer(shape_, halves.data(), first, last - first, tile_row * shape_.tile_height));
    file_->output->writeTiles(left / shape_.tile_width, (right - 1) / shape_.tile_width, tile_row, tile_row);
  } catch (const std::exception& error) {
    fail_to_write(path_, file_->stream.problem().empty() ? error.what() : file_->stream.problem());
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
  explicit File(const std::filesystem::path& path) : input(path.c_str(), thread_count()) {}
  Imf::TiledInputFile input;
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
  } catch (const std::exception& error) {
    throw Error({path.string(), "header", fmt::format("cannot be read: {}", error.what()), kExpected});
  }
  const Imf::Header& header = file_->input.header();
  const Imath::Box2i display = header.displayWindow(), data = header.dataWindow();
  bool sensible = display.min == Imath::V2i(0, 0) && data.min.y == 0 && data.max.y == display.max.y &&
                  data.min.x >= 0 && data.max.x <= display.max.x && display.max.x < kMostPixelsAcross &&
                  header.tileDescription().mode == Imf::ONE_LEVEL;
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

bool ExrTileReader::read(int tile_row, int tile_row_end, int first, int last, std::span<float> pixels) {
  int rows = 0;
  for (int row = tile_row; row < tile_row_end; ++row) rows += shape_.rows_of(row);
  CHIARO_CHECK(pixels.size() == std::size_t(rows) * std::size_t(last - first) * shape_.channels.size());
  std::vector<half> halves(pixels.size());
  const int left = first - shape_.first_column, right = last - shape_.first_column;
  try {
    file_->input.setFrameBuffer(
        frame_buffer(shape_, halves.data(), first, last - first, tile_row * shape_.tile_height));
    file_->input.readTiles(left / shape_.tile_width, (right - 1) / shape_.tile_width, tile_row, tile_row_end - 1);
  } catch (const std::exception&) {
    return false;
  }
  std::copy(halves.begin(), halves.end(), pixels.begin());
  return true;
}

}  // namespace chiaro::renderer
