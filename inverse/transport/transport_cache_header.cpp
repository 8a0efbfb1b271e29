#include "inverse/transport/transport_cache_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "inverse/transport/number_ranges.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

using renderer::Attributes;
using renderer::Error;

constexpr int kFormatVersion = 1;
constexpr int kMostAlongAxis = 1'000'000;  // as --grid takes them
constexpr int kMostSamples = 1 << 24, kMostBounces = 10000;
constexpr double kLargestError = std::numeric_limits<float>::max();

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
      if (counts[a] < 1 || counts[a] > kMostAlongAxis)
        throw Error({file_, "header", "chiaro:grid_counts is out of range", kNotACache});
      at = std::min(comma + 1, text.size());
    }
    return counts;
  }

 private:
  const Attributes& attributes_;
  std::string file_;
};

// A grid's cells fill its region, which may be flat, but no point. False where anything is not finite.
bool fills_region(const LightGrid& grid) {
  if (!(grid.region.diagonal() > 0)) return false;
  for (int a = 0; a < 3; ++a) {
    const float extent = grid.region.extent()[a];
    // Of many cells the spacing is rounded more than that.
    const float tolerance = std::max(1e-3F * grid.spacing[a], 4 * std::numeric_limits<float>::epsilon() * extent);
    const bool spaced = std::abs(grid.spacing[a] * float(grid.counts[a]) - extent) <= tolerance;
    const bool begun = std::abs(grid.region.min[a] + 0.5F * grid.spacing[a] - grid.origin[a]) <= 1e-3F * extent;
    if (!spaced || !begun) return false;
  }
  return true;
}

std::size_t node_count(const LightGrid& grid) {
  return std::size_t(grid.counts[0]) * std::size_t(grid.counts[1]) * std::size_t(grid.counts[2]);
}

// Numbers below `end`, at least one and at most `most`.
std::vector<int> read_numbers(const std::string& text, const std::string& name, double end, std::size_t most,
                              const std::string& file) {
  auto numbers = parse_number_ranges(text, most);
  if (numbers && !numbers->empty() && double(numbers->back()) < end) return std::move(*numbers);
  throw Error({file, "header", fmt::format("chiaro:{} does not fit the grid and the rows", name), kNotACache});
}

std::vector<LightGrid::FinerCell> read_finer_cells(const Header& header, const std::string& file, double nodes,
                                                   std::size_t most) {
  std::vector<LightGrid::FinerCell> cells;
  for (int level = 1; level <= kMostLevels; ++level) {
    const std::string name = name_of_level(level);
    const auto* text = header.find<std::string>(name);
    if (text == nullptr) continue;
    const double end = nodes * double(1 << (3 * level));
    for (const int number : read_numbers(*text, name, end, most - cells.size(), file)) {
      cells.push_back({level, std::uint64_t(number)});
    }
  }
  return cells;
}

// rows: as many as the file has lights. Takes no memory for nodes before they are as many.
LightGrid read_grid(const Header& header, const std::string& file, std::size_t rows) {
  constexpr std::size_t kMostNodes = 100'000'000;
  LightGrid grid;
  grid.region = {header.vector("region_min"), header.vector("region_max")};
  grid.origin = header.vector("grid_origin");
  grid.spacing = header.vector("grid_spacing");
  grid.counts = header.counts();
  if (!in_world(grid.region.min) || !in_world(grid.region.max)) {
    throw Error({file, "header", "the region of the lights reaches beyond the world", kNotACache});
  }
  if (!fills_region(grid)) throw Error({file, "header", "the light grid does not fill its region", kNotACache});
  const std::size_t count = node_count(grid);
  if (count > kMostNodes) throw Error({file, "header", "chiaro:grid_counts is out of range", kNotACache});
  const std::vector<int> nodes =
      read_numbers(header.get<std::string>("grid_nodes"), "grid_nodes", double(count), rows, file);
  auto finer = read_finer_cells(header, file, double(count), rows - nodes.size());
  if (nodes.size() + finer.size() != rows) {
    throw Error({file, "", fmt::format("{} rows for {} lights", rows, nodes.size() + finer.size()), kNotACache});
  }
  grid.light_of_node.assign(count, -1);
  for (const int node : nodes) {
    grid.light_of_node[node] = int(grid.positions.size());
    const int x = node % grid.counts[0], y = node / grid.counts[0] % grid.counts[1];
    const int z = node / grid.counts[0] / grid.counts[1];
    grid.positions.push_back(grid.origin + grid.spacing * Vec3f{float(x), float(y), float(z)});
  }
  set_finer_cells(grid, std::move(finer));
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
      {"chiaro:indirect_relative_error", float(std::min(cache.indirect_relative_error, kLargestError))}};
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
  cache.grid = read_grid(header, name, std::size_t(lights));
  cache.receiver_count = std::size_t(receivers);
  cache.scene_fingerprint = header.get<std::string>("scene_fingerprint");
  cache.receiver_fingerprint = header.get<std::string>("receiver_fingerprint");
  cache.settings.samples = header.get<int>("samples");
  if (cache.settings.samples < 1 || cache.settings.samples > kMostSamples) {
    throw Error({name, "header", fmt::format("chiaro:samples is {}", cache.settings.samples),
                 fmt::format("1 to {}", kMostSamples)});
  }
  cache.settings.bounces = header.get<int>("bounces");
  if (cache.settings.bounces < -1 || cache.settings.bounces > kMostBounces) {
    throw Error({name, "header", fmt::format("chiaro:bounces is {}", cache.settings.bounces),
                 fmt::format("0 to {}, or -1 for all", kMostBounces)});
  }
  cache.settings.seed = header.parse<std::uint64_t>(header.get<std::string>("seed"), "seed");
  cache.settings.materials = header.get<std::string>("materials");
  cache.indirect_relative_error = double(header.get<float>("indirect_relative_error"));
  if (!(cache.indirect_relative_error >= 0) || !std::isfinite(cache.indirect_relative_error)) {
    throw Error({name, "header", fmt::format("chiaro:indirect_relative_error is {}", cache.indirect_relative_error),
                 "a finite number, 0 or more"});
  }
  cache.indirect_scale = header.get<float>("indirect_scale");
  if (!(cache.indirect_scale > 0) || !std::isfinite(cache.indirect_scale))
    throw Error({name, "header", "chiaro:indirect_scale is not positive", kNotACache});
  return cache;
}

}  // namespace chiaro::inverse
