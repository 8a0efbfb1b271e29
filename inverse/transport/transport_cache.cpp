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

constexpr std::size_t kEntriesAtOnce = std::size_t{1} << 22;  // that are read

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

// What no bake writes is no number, for require_transport().
Entry entry_of(const float* pixel, const std::array<int, 4>& channels, float scale) {
  const float visibility = pixel[channels[3]];
  const Vec3f indirect{pixel[channels[2]], pixel[channels[1]], pixel[channels[0]]};
  const bool is_transport = (visibility == 0 || visibility == 1) && min_component(indirect) >= 0;
  return {std::uint8_t(visibility == 1), is_transport ? indirect / scale : Vec3f{NAN, NAN, NAN}};
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
void require_transport(const TransportCache& cache, std::span<const std::size_t> receivers, const std::string& file) {
  const auto bad = std::find_if_not(cache.indirect.begin(), cache.indirect.end(), [](Vec3f v) { return is_finite(v); });
  if (bad == cache.indirect.end()) return;
  const auto i = std::size_t(bad - cache.indirect.begin());
  throw Error({file, fmt::format("light {}, receiver {}", i / receivers.size(), receivers[i % receivers.size()]),
               "is no light transport: finite, not negative, and a visibility of 0 or 1", kNotACache});
}

// Receivers that are read at once, and where in the list those begin that are wanted of them.
struct Run {
  std::size_t first, last;
  std::size_t column, wanted;
};

// Ascending receivers, those of a tile together as far as memory allows for as many lights as it has.
std::vector<Run> runs_of(std::span<const std::size_t> receivers, const TransportCacheReader& reader) {
  constexpr std::size_t kMost = 256;
  const std::size_t lights = std::min(reader.lights_of_tile(), reader.header().grid.positions.size());
  const std::size_t tile = reader.receivers_of_tile(), most_of_tile = std::max<std::size_t>(1, kEntriesAtOnce / lights);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const std::size_t from_tile = runs.empty() ? 0 : receivers[i] / tile - (runs.back().last - 1) / tile;
    const std::size_t most = from_tile == 0 ? most_of_tile : from_tile == 1 ? std::min(kMost, most_of_tile) : 0;
    if (!runs.empty() && receivers[i] - runs.back().first < most) {
      runs.back().last = receivers[i] + 1;
      ++runs.back().wanted;
    } else {
      runs.push_back({receivers[i], receivers[i] + 1, i, 1});
    }
  }
  return runs;
}

// Lights that are read at once of so many receivers: whole tiles.
std::size_t lights_at_once(const TransportCacheReader& reader, std::size_t receivers) {
  const std::size_t tile = reader.lights_of_tile();
  return std::max(tile, kEntriesAtOnce / receivers / tile * tile);
}

// receivers: those wanted of the run.
void copy_columns(const TransportBlock& block, std::span<const std::size_t> receivers, std::size_t column,
                  TransportCache& cache) {
  for (std::size_t light = 0; light < block.light_count; ++light) {
    for (std::size_t k = 0; k < receivers.size(); ++k) {
      const std::size_t from = light * block.receiver_count + receivers[k] - block.first_receiver;
      const std::size_t to = (block.first_light + light) * cache.receiver_count + column + k;
      cache.visibility[to] = block.visibility[from];
      cache.indirect[to] = block.indirect[from];
    }
  }
}

void read_tiles(TransportCacheReader& reader, std::span<const std::size_t> receivers, const std::string& name,
                TransportCache& cache) {
  const std::size_t lights = cache.grid.positions.size();
  for (const Run& run : runs_of(receivers, reader)) {
    TransportBlock block;
    block.first_receiver = run.first, block.receiver_count = run.last - run.first;
    const std::size_t step = lights_at_once(reader, block.receiver_count);
    for (std::size_t light = 0; light < lights; light += step) {
      block.first_light = light, block.light_count = std::min(step, lights - light);
      if (!reader.read(block)) {
        throw Error({name, fmt::format("receiver {}", run.first), "cut short or damaged", "a whole file"});
      }
      copy_columns(block, receivers.subspan(run.column, run.wanted), run.column, cache);
    }
  }
}

void read_scanlines(const renderer::ImageFile& file, std::span<const std::size_t> receivers,
                    const std::filesystem::path& path, TransportCache& cache) {
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
  TransportBlock last;
  last.first_light = reader.header().grid.positions.size() - 1, last.light_count = 1;
  last.first_receiver = reader.last_receiver() - 1, last.receiver_count = 1;
  if (!reader.read(last)) throw Error({name, "", "cut short or damaged", "a whole file"});
  if (reader.first_receiver() == 0 && reader.last_receiver() == reader.header().receiver_count) return;
  throw Error({name, "header",
               fmt::format("a part of a cache: receivers {} to {} of {}", reader.first_receiver(),
                           reader.last_receiver() - 1, reader.header().receiver_count),
               "a whole one: join the parts with `chiaro merge`"});
}

// Before memory is taken for what the header says of each light.
void require_room_for_entries(std::size_t lights, std::size_t receivers, const std::filesystem::path& path) {
  constexpr std::size_t kEntryBytes = 8;
  const std::size_t entries = lights * receivers;
  std::error_code no_size;
  const std::uintmax_t bytes = std::filesystem::file_size(path, no_size);
  if (no_size || renderer::may_hold(bytes, kEntryBytes * entries)) return;
  throw Error({path.string(), "header", fmt::format("has more entries ({}) than such a file can hold", entries),
               "a whole file"});
}

TransportCache header_of_scanlines(const renderer::ImageFile& file, const std::filesystem::path& path) {
  if (file.part) throw Error({path.string(), "dataWindow", "is a part of a cache", "a whole one"});
  require_room_for_entries(std::size_t(file.image.height), std::size_t(file.image.width), path);
  return transport_cache_from(file.attributes, file.image.width, file.image.height, path.string());
}

// Of a file of tiles.
TransportCache header_of(const renderer::ExrTileReader& file) {
  const renderer::ExrTiles& shape = file.shape();
  require_room_for_entries(std::size_t(shape.height), std::size_t(shape.last_column - shape.first_column), file.path());
  return transport_cache_from(file.attributes(), shape.width, shape.height, file.path().string());
}

}  // namespace

float indirect_scale_for(float across) {
  // Light that went round a room of diagonal d brings about 1 / d². Halves lose precision below 1/250 of that as it is
  // stored, and end beyond four million times as much, which is next to a surface that a light all but touches.
  constexpr float kTypical = 1.0F / 64;
  return across > 0 ? std::exp2(std::floor(std::log2(kTypical * across * across))) : 1.0F;
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
  for (std::size_t light = 0; light < block.light_count; light += kLights) {
    const std::size_t lights = std::min(kLights, block.light_count - light), row = 4 * block.receiver_count;
    file_.write(int((block.first_light + light) / kLights), int(block.first_receiver),
                int(block.first_receiver + block.receiver_count), std::span(pixels).subspan(light * row, lights * row));
  }
}

void TransportCacheWriter::close() { file_.close(); }

TransportCacheReader::TransportCacheReader(const std::filesystem::path& path)
    : file_(path), header_(header_of(file_)), channels_(find_channels(file_.shape().channels, path.string())) {}

bool TransportCacheReader::is_of(const TransportCache& header) const {
  return transport_cache_attributes(header_) == transport_cache_attributes(header);
}

bool TransportCacheReader::read(TransportBlock& block) {
  block.resize();
  const std::size_t width = file_.shape().channels.size();
  std::vector<float> pixels(width * block.visibility.size());
  if (!file_.read(int(block.first_light), int(block.first_light + block.light_count), int(block.first_receiver),
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
  return header_of_scanlines(renderer::load_image_header(path), path);
}

TransportCache load_transport_cache(const std::filesystem::path& path,
                                    std::optional<std::span<const std::size_t>> receivers) {
  // Header and entries of one file, whatever takes its name meanwhile.
  std::optional<TransportCacheReader> tiles;
  renderer::ImageFile scanlines;
  if (renderer::ExrTileReader::is_tiled(path)) {
    tiles.emplace(path);
    require_whole(*tiles, path.string());
  } else {
    load_transport_cache_header(path);  // refuses what is too large before it takes memory
    scanlines = renderer::load_image(path);
  }
  TransportCache cache = tiles ? tiles->header() : header_of_scanlines(scanlines, path);
  std::vector<std::size_t> all;
  if (!receivers) {
    all.resize(cache.receiver_count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    receivers = all;
  } else if (std::any_of(receivers->begin(), receivers->end(),
                         [&](std::size_t r) { return r >= cache.receiver_count; })) {
    throw Error({path.string(), "header", fmt::format("has {} receivers, fewer than before", cache.receiver_count),
                 "the cache as it was"});
  }
  cache.receiver_count = receivers->size();
  cache.visibility.resize(cache.grid.positions.size() * receivers->size());
  cache.indirect.resize(cache.visibility.size());
  if (tiles) {
    read_tiles(*tiles, *receivers, path.string(), cache);
  } else {
    read_scanlines(scanlines, *receivers, path, cache);
  }
  require_transport(cache, *receivers, path.string());
  return cache;
}

}  // namespace chiaro::inverse
