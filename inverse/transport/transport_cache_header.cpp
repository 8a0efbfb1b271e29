#include "inverse/transport/transport_cache_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "inverse/transport/number_ranges.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using renderer::Attributes;
using renderer::Error;

constexpr int kFormatVersion = 1;
constexpr int kMostSamples = 1 << 24;

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

}  // namespace

Attributes transport_cache_attributes(const TransportCache& cache) {
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

TransportCache transport_cache_from(const Attributes& attributes, int receivers, int lights, const std::string& name) {
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
  if (cache.settings.samples < 1 || cache.settings.samples > kMostSamples) {
    throw Error({name, "header", fmt::format("chiaro:samples is {}", cache.settings.samples),
                 fmt::format("1 to {}", kMostSamples)});
  }
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

}  // namespace chiaro::inverse
