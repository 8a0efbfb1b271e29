#include "inverse/transport/transport_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "inverse/transport/transport_cache_header.h"
#include "renderer/core/error.h"
#include "renderer/image/encoded_image.h"
#include "renderer/image/image_file.h"

namespace chiaro::inverse {
namespace {

using renderer::Attributes;
using renderer::Error;

// As OpenEXR orders them.
const std::vector<std::string> kChannels{"indirect.B", "indirect.G", "indirect.R", "visibility"};

std::array<int, 4> find_channels(const std::vector<std::string>& names, const std::string& file) {
  std::array<int, 4> channels{};
  for (int c = 0; c < 4; ++c) {
    const auto found = std::find(names.begin(), names.end(), kChannels[c]);
    if (found == names.end()) throw Error({file, "", "no channel " + kChannels[c], kNotACache});
    channels[c] = int(found - names.begin());
  }
  return channels;
}

struct Entry {
  std::uint8_t visibility;
  Vec3f indirect;
};

Entry entry_of(const float* pixel, const std::array<int, 4>& channels, float scale) {
  return {std::uint8_t(pixel[channels[3]] > 0.5F ? 1 : 0),
          Vec3f{pixel[channels[2]], pixel[channels[1]], pixel[channels[0]]} / scale};
}

renderer::ExrTiles shape_of(const TransportCache& cache, std::size_t first, std::size_t last) {
  return {.width = int(cache.receiver_count),
          .height = int(cache.grid.positions.size()),
          .first_column = int(first),
          .last_column = int(last),
          .tile_width = int(TransportCacheWriter::receivers_of_tile(cache.grid.positions.size())),
          .tile_height = int(TransportCacheWriter::kLights),
          .channels = kChannels};
}

// receivers: of the columns.
void require_finite(const TransportCache& cache, std::span<const std::size_t> receivers, const std::string& file) {
  const auto bad = std::find_if_not(cache.indirect.begin(), cache.indirect.end(), [](Vec3f v) { return is_finite(v); });
  if (bad == cache.indirect.end()) return;
  const auto i = std::size_t(bad - cache.indirect.begin());
  throw Error({file, fmt::format("light {}, receiver {}", i / receivers.size(), receivers[i % receivers.size()]),
               "not a finite value", kNotACache});
}

// Receivers that are read at once, and where in the list those begin that are wanted of them.
struct Run {
  std::size_t first, last;
  std::size_t column, wanted;
};

// Ascending receivers in whole tiles.
std::vector<Run> runs_of(std::span<const std::size_t> receivers, std::size_t tile, std::size_t all) {
  constexpr std::size_t kMost = 256;
  std::vector<Run> runs;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const std::size_t first = receivers[i] / tile * tile, last = std::min(first + tile, all);
    if (!runs.empty() && first <= runs.back().last && last - runs.back().first <= kMost) {
      runs.back().last = last;
      ++runs.back().wanted;
    } else {
      runs.push_back({first, last, i, 1});
    }
  }
  return runs;
}

void read_tiles(TransportCacheReader& reader, std::span<const std::size_t> receivers, const std::string& name,
                TransportCache& cache) {
  TransportBlock block;
  block.light_count = cache.grid.positions.size();
  for (const Run& run : runs_of(receivers, reader.receivers_of_tile(), reader.last_receiver())) {
    block.first_receiver = run.first, block.receiver_count = run.last - run.first;
    if (!reader.read(block)) {
      throw Error({name, fmt::format("receiver {}", run.first), "cut short or damaged", "a whole file"});
    }
    for (std::size_t k = run.column; k < run.column + run.wanted; ++k) {
      for (std::size_t light = 0; light < block.light_count; ++light) {
        const std::size_t from = light * block.receiver_count + receivers[k] - run.first;
        cache.visibility[light * cache.receiver_count + k] = block.visibility[from];
        cache.indirect[light * cache.receiver_count + k] = block.indirect[from];
      }
    }
  }
}

void read_scanlines(const std::filesystem::path& path, std::span<const std::size_t> receivers, TransportCache& cache) {
  const renderer::ImageFile file = renderer::load_image(path);
  const std::array<int, 4> channels = find_channels(file.image.channel_names, path.string());
  for (std::size_t light = 0; light < cache.grid.positions.size(); ++light) {
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      const Entry entry = entry_of(file.image.at(int(receivers[i]), int(light)), channels, cache.indirect_scale);
      cache.visibility[light * receivers.size() + i] = entry.visibility;
      cache.indirect[light * receivers.size() + i] = entry.indirect;
    }
  }
}

// All receivers, to the last tile: it is the last that is written.
void require_whole(TransportCacheReader& reader, const std::string& name) {
  const std::size_t lights = reader.header().grid.positions.size();
  TransportBlock last;
  last.first_light = (lights - 1) / reader.lights_of_tile() * reader.lights_of_tile();
  last.light_count = lights - last.first_light;
  last.first_receiver = (reader.last_receiver() - 1) / reader.receivers_of_tile() * reader.receivers_of_tile();
  last.receiver_count = reader.last_receiver() - last.first_receiver;
  if (!reader.read(last)) throw Error({name, "", "cut short or damaged", "a whole file"});
  if (reader.first_receiver() == 0 && reader.last_receiver() == reader.header().receiver_count) return;
  throw Error({name, "header",
               fmt::format("a part of a cache: receivers {} to {} of {}", reader.first_receiver(),
                           reader.last_receiver() - 1, reader.header().receiver_count),
               "a whole one: join the parts with `chiaro merge`"});
}

void require_room_for_entries(const TransportCache& cache, const std::filesystem::path& path) {
  constexpr std::size_t kEntryBytes = 8;
  const std::size_t entries = cache.grid.positions.size() * cache.receiver_count;
  if (renderer::may_hold(std::filesystem::file_size(path), kEntryBytes * entries)) return;
  throw Error({path.string(), "header", fmt::format("has more entries ({}) than such a file can hold", entries),
               "a whole file"});
}

}  // namespace

float indirect_scale_for(const Box3f& bounds) {
  // Light that went round a scene of diagonal d brings about 1 / d². Halves lose precision below 1/250 of that as it is
  // stored, and end beyond four million times as much, which is next to a surface that a light all but touches.
  constexpr float kTypical = 1.0F / 64;
  const float d = bounds.diagonal();
  return d > 0 ? std::exp2(std::floor(std::log2(kTypical * d * d))) : 1.0F;
}

void TransportBlock::resize() {
  visibility.assign(light_count * receiver_count, 0);
  indirect.assign(light_count * receiver_count, Vec3f{});
}

std::size_t TransportCacheWriter::receivers_of_tile(std::size_t lights) {
  return std::bit_floor(std::clamp(kLights / std::max<std::size_t>(1, lights), std::size_t{1}, kMostReceivers));
}

TransportCacheWriter::TransportCacheWriter(const std::filesystem::path& path, const TransportCache& header,
                                           std::size_t first_receiver, std::size_t last_receiver)
    : scale_(header.indirect_scale),
      file_(path, shape_of(header, first_receiver, last_receiver), transport_cache_attributes(header)) {}

void TransportCacheWriter::write(const TransportBlock& block) {
  std::vector<float> pixels(4 * block.visibility.size());
  for (std::size_t i = 0; i < block.visibility.size(); ++i) {
    const Vec3f stored = scale_ * block.indirect[i];
    const float pixel[4] = {stored.z, stored.y, stored.x, block.visibility[i] != 0 ? 1.0F : 0.0F};
    std::copy_n(pixel, 4, &pixels[4 * i]);
  }
  file_.write(int(block.first_light / kLights), int(block.first_receiver),
              int(block.first_receiver + block.receiver_count), pixels);
}

void TransportCacheWriter::close() { file_.close(); }

TransportCacheReader::TransportCacheReader(const std::filesystem::path& path)
    : file_(path),
      header_(transport_cache_from(file_.attributes(), file_.shape().width, file_.shape().height, path.string())),
      channels_(find_channels(file_.shape().channels, path.string())) {
  const renderer::ExrTiles& shape = file_.shape();
  if (shape.first_column % shape.tile_width != 0) {
    throw Error({path.string(), "header", "begins within a tile", kNotACache});
  }
}

bool TransportCacheReader::is_of(const TransportCache& header) const {
  const Attributes expected = transport_cache_attributes(header);
  const Attributes& found = file_.attributes();
  return std::all_of(expected.begin(), expected.end(), [&](const auto& attribute) {
    return std::find(found.begin(), found.end(), attribute) != found.end();
  });
}

bool TransportCacheReader::read(TransportBlock& block) {
  const renderer::ExrTiles& shape = file_.shape();
  CHIARO_CHECK(block.first_light % std::size_t(shape.tile_height) == 0);
  block.resize();
  const std::size_t tile_height = std::size_t(shape.tile_height), width = shape.channels.size();
  const std::size_t row = block.first_light / tile_height;
  const std::size_t rows = (block.light_count + tile_height - 1) / tile_height;
  std::vector<float> pixels(width * block.visibility.size());
  if (!file_.read(int(row), int(row + rows), int(block.first_receiver),
                  int(block.first_receiver + block.receiver_count), pixels)) {
    return false;
  }
  for (std::size_t i = 0; i < block.visibility.size(); ++i) {
    const Entry entry = entry_of(&pixels[width * i], channels_, header_.indirect_scale);
    block.visibility[i] = entry.visibility, block.indirect[i] = entry.indirect;
  }
  return true;
}

TransportCache load_transport_cache_header(const std::filesystem::path& path) {
  if (renderer::ExrTileReader::is_tiled(path)) {
    TransportCacheReader reader(path);
    require_whole(reader, path.string());
    return reader.header();
  }
  const renderer::ImageFile file = renderer::load_image_header(path);
  return transport_cache_from(file.attributes, file.image.width, file.image.height, path.string());
}

TransportCache load_transport_cache(const std::filesystem::path& path,
                                    std::optional<std::span<const std::size_t>> receivers) {
  TransportCache cache = load_transport_cache_header(path);
  std::vector<std::size_t> all;
  if (!receivers) {
    all.resize(cache.receiver_count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    receivers = all;
  }
  cache.receiver_count = receivers->size();
  require_room_for_entries(cache, path);
  cache.visibility.resize(cache.grid.positions.size() * receivers->size());
  cache.indirect.resize(cache.visibility.size());
  if (renderer::ExrTileReader::is_tiled(path)) {
    TransportCacheReader reader(path);
    read_tiles(reader, *receivers, path.string(), cache);
  } else {
    read_scanlines(path, *receivers, cache);
  }
  require_finite(cache, *receivers, path.string());
  return cache;
}

}  // namespace chiaro::inverse
