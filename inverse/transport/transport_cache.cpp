#include "inverse/transport/transport_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <numeric>

#include "inverse/transport/number_ranges.h"
#include "renderer/core/error.h"
#include "renderer/image/encoded_image.h"
#include "renderer/image/image_file.h"

namespace chiaro::inverse {
namespace {

using renderer::Attributes;
using renderer::Error;

constexpr int kFormatVersion = 1;
const char* const kNotACache = "a transport cache made by `chiaro bake`";
// As OpenEXR orders them.
const std::vector<std::string> kChannels{"indirect.B", "indirect.G", "indirect.R", "visibility"};

std::array<float, 3> array_of(Vec3f v) { return {v.x, v.y, v.z}; }

std::vector<int> nodes_of_lights(const LightGrid& grid) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < grid.light_of_node.size(); ++i) {
    if (grid.light_of_node[i] >= 0) nodes.push_back(int(i));
  }
  return nodes;
}

std::string name_of_level(int level) { return fmt::format("grid_finer_{}", level); }

void append_finer_cells(const LightGrid& grid, Attributes& attributes) {
  for (int level = 1; level <= kMostLevels; ++level) {
    std::vector<int> numbers;
    for (const LightGrid::FinerCell& cell : grid.finer) {
      if (cell.level == level) numbers.push_back(int(cell.number));
    }
    if (!numbers.empty()) attributes.emplace_back("chiaro:" + name_of_level(level), format_number_ranges(numbers));
  }
}

Attributes header_of(const TransportCache& cache) {
  const LightGrid& grid = cache.grid;
  Attributes attributes{
      {"chiaro:kind", std::string("transport cache")},
      {"chiaro:format_version", kFormatVersion},
      {"chiaro:units",
       std::string("indirect / indirect_scale: illumination in cd/m^2 per candela; visibility: 0 or 1")},
      {"chiaro:indirect_scale", cache.indirect_scale},
      {"chiaro:region_min", array_of(grid.region.min)},
      {"chiaro:region_max", array_of(grid.region.max)},
      {"chiaro:grid_origin", array_of(grid.origin)},
      {"chiaro:grid_spacing", array_of(grid.spacing)},
      {"chiaro:grid_counts", fmt::format("{},{},{}", grid.counts[0], grid.counts[1], grid.counts[2])},
      {"chiaro:grid_nodes", format_number_ranges(nodes_of_lights(grid))},
      {"chiaro:scene_fingerprint", cache.scene_fingerprint},
      {"chiaro:receiver_fingerprint", cache.receiver_fingerprint},
      {"chiaro:samples", cache.settings.samples},
      {"chiaro:bounces", cache.settings.bounces},
      {"chiaro:seed", fmt::format("{}", cache.settings.seed)},
      {"chiaro:materials", cache.settings.materials},
      {"chiaro:indirect_relative_error", float(cache.indirect_relative_error)}};
  append_finer_cells(grid, attributes);
  return attributes;
}

// Header values by name, each an Error where it is missing or of another kind.
class Header {
 public:
  Header(const Attributes& attributes, std::string file) : attributes_(attributes), file_(std::move(file)) {}

  template <class T>
  const T* find(const std::string& name) const {
    for (const auto& [key, value] : attributes_) {
      if (key != "chiaro:" + name) continue;
      if (const T* typed = std::get_if<T>(&value)) return typed;
    }
    return nullptr;
  }

  template <class T>
  const T& get(const std::string& name) const {
    if (const T* value = find<T>(name)) return *value;
    throw Error({file_, "header", "no attribute chiaro:" + name, kNotACache});
  }

  Vec3f vector(const std::string& name) const {
    const auto& v = get<std::array<float, 3>>(name);
    return {v[0], v[1], v[2]};
  }

  template <class T>
  T parse(const std::string& text, const std::string& name) const {
    T value{};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size()) {
      throw Error({file_, "header", fmt::format("chiaro:{} is \"{}\"", name, text), "a number"});
    }
    return value;
  }

  std::array<int, 3> counts() const {
    const std::string& text = get<std::string>("grid_counts");
    if (std::count(text.begin(), text.end(), ',') != 2)
      throw Error({file_, "header", fmt::format("chiaro:grid_counts is \"{}\"", text), "three whole numbers"});
    std::array<int, 3> counts{};
    std::size_t at = 0;
    for (int a = 0; a < 3; ++a) {
      const std::size_t comma = std::min(text.find(',', at), text.size());
      counts[a] = parse<int>(text.substr(at, comma - at), "grid_counts");
      if (counts[a] < 1 || counts[a] > 100000)
        throw Error({file_, "header", "chiaro:grid_counts is out of range", kNotACache});
      at = std::min(comma + 1, text.size());
    }
    return counts;
  }

 private:
  const Attributes& attributes_;
  std::string file_;
};

// A grid's cells fill its region. False where anything is not finite.
bool fills_region(const LightGrid& grid) {
  for (int a = 0; a < 3; ++a) {
    const float extent = grid.region.extent()[a], tolerance = 1e-3F * grid.spacing[a];
    const bool spaced = std::abs(grid.spacing[a] * float(grid.counts[a]) - extent) <= tolerance;
    const bool begun = std::abs(grid.region.min[a] + 0.5F * grid.spacing[a] - grid.origin[a]) <= 1e-3F * extent;
    if (!spaced || !begun) return false;
  }
  return true;
}

void read_finer_cells(const Header& header, const std::string& file, LightGrid& grid) {
  std::vector<LightGrid::FinerCell> cells;
  for (int level = 1; level <= kMostLevels; ++level) {
    const auto* text = header.find<std::string>(name_of_level(level));
    if (text == nullptr) continue;
    const auto numbers = parse_number_ranges(*text);
    const double count = double(grid.light_of_node.size()) * double(1 << (3 * level));
    if (!numbers || numbers->empty() || double(numbers->back()) >= count) {
      throw Error({file, "header", fmt::format("chiaro:{} does not fit the grid", name_of_level(level)), kNotACache});
    }
    for (const int number : *numbers) cells.push_back({level, std::uint64_t(number)});
  }
  set_finer_cells(grid, std::move(cells));
}

LightGrid read_grid(const Header& header, const std::string& file) {
  LightGrid grid;
  grid.region = {header.vector("region_min"), header.vector("region_max")};
  grid.origin = header.vector("grid_origin");
  grid.spacing = header.vector("grid_spacing");
  grid.counts = header.counts();
  if (!fills_region(grid)) throw Error({file, "header", "the light grid does not fill its region", kNotACache});
  const auto nodes = parse_number_ranges(header.get<std::string>("grid_nodes"));
  const std::size_t node_count = std::size_t(grid.counts[0]) * grid.counts[1] * grid.counts[2];
  if (!nodes || nodes->empty() || std::size_t(nodes->back()) >= node_count || node_count > 100'000'000) {
    throw Error({file, "header", "chiaro:grid_nodes does not fit the grid", kNotACache});
  }
  grid.light_of_node.assign(node_count, -1);
  for (const int node : *nodes) {
    grid.light_of_node[node] = int(grid.positions.size());
    const int x = node % grid.counts[0], y = node / grid.counts[0] % grid.counts[1];
    const int z = node / grid.counts[0] / grid.counts[1];
    grid.positions.push_back(grid.origin + grid.spacing * Vec3f{float(x), float(y), float(z)});
  }
  read_finer_cells(header, file, grid);
  return grid;
}

// `receivers`, `lights`: as the picture's size has them.
TransportCache read_header(const Attributes& attributes, int receivers, int lights, const std::string& name) {
  const Header header(attributes, name);
  if (header.get<std::string>("kind") != "transport cache")
    throw Error({name, "header", "not a transport cache", kNotACache});
  if (const int version = header.get<int>("format_version"); version != kFormatVersion) {
    throw Error({name, "header", fmt::format("cache format {}", version),
                 fmt::format("format {}: bake again", kFormatVersion)});
  }
  TransportCache cache;
  cache.grid = read_grid(header, name);
  cache.receiver_count = std::size_t(receivers);
  cache.scene_fingerprint = header.get<std::string>("scene_fingerprint");
  cache.receiver_fingerprint = header.get<std::string>("receiver_fingerprint");
  cache.settings.samples = header.get<int>("samples");
  cache.settings.bounces = header.get<int>("bounces");
  cache.settings.seed = header.parse<std::uint64_t>(header.get<std::string>("seed"), "seed");
  cache.settings.materials = header.get<std::string>("materials");
  cache.indirect_relative_error = double(header.get<float>("indirect_relative_error"));
  cache.indirect_scale = header.get<float>("indirect_scale");
  if (!(cache.indirect_scale > 0) || !std::isfinite(cache.indirect_scale))
    throw Error({name, "header", "chiaro:indirect_scale is not positive", kNotACache});
  if (std::size_t(lights) != cache.grid.positions.size()) {
    throw Error({name, "", fmt::format("{} rows for {} lights", lights, cache.grid.positions.size()), kNotACache});
  }
  return cache;
}

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
    : scale_(header.indirect_scale), file_(path, shape_of(header, first_receiver, last_receiver), header_of(header)) {}

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
      header_(read_header(file_.attributes(), file_.shape().width, file_.shape().height, path.string())),
      channels_(find_channels(file_.shape().channels, path.string())) {
  const renderer::ExrTiles& shape = file_.shape();
  if (shape.first_column % shape.tile_width != 0) {
    throw Error({path.string(), "header", "begins within a tile", kNotACache});
  }
}

bool TransportCacheReader::is_of(const TransportCache& header) const {
  const Attributes expected = header_of(header);
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
  return read_header(file.attributes, file.image.width, file.image.height, path.string());
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
