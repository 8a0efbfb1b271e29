#include "inverse/transport/transport_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "inverse/transport/number_ranges.h"
#include "renderer/core/error.h"
#include "renderer/image/image_file.h"

namespace chiaro::inverse {
namespace {

using renderer::Attributes;
using renderer::Error;
using renderer::Image;

constexpr int kFormatVersion = 1;
constexpr float kLargestStored = 1024;  // keeps halves far from their limits
const char* const kNotACache = "a transport cache made by `chiaro bake`";
const std::vector<std::string> kChannels{"visibility", "indirect.R", "indirect.G", "indirect.B"};

// A power of two, so that scaling loses nothing: indirect × scale is at most about kLargestStored.
float indirect_scale(const TransportCache& cache) {
  float largest = 0;
  for (const Vec3f& v : cache.indirect) largest = std::max(largest, max_component(v));
  return largest > 0 ? std::exp2(std::floor(std::log2(kLargestStored / largest))) : 1.0F;
}

std::array<float, 3> array_of(Vec3f v) { return {v.x, v.y, v.z}; }

std::vector<int> nodes_of_lights(const LightGrid& grid) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < grid.light_of_node.size(); ++i) {
    if (grid.light_of_node[i] >= 0) nodes.push_back(int(i));
  }
  return nodes;
}

Attributes header_of(const TransportCache& cache, float scale) {
  const LightGrid& grid = cache.grid;
  return {{"chiaro:kind", std::string("transport cache")},
          {"chiaro:format_version", kFormatVersion},
          {"chiaro:units",
           std::string("indirect / indirect_scale: illumination in cd/m^2 per candela; visibility: 0 or 1")},
          {"chiaro:indirect_scale", scale},
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
}

// Header values by name, each an Error where it is missing or of another kind.
class Header {
 public:
  Header(const Attributes& attributes, std::string file) : attributes_(attributes), file_(std::move(file)) {}

  template <class T>
  const T& get(const std::string& name) const {
    for (const auto& [key, value] : attributes_) {
      if (key != "chiaro:" + name) continue;
      if (const T* typed = std::get_if<T>(&value)) return *typed;
    }
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
  return grid;
}

TransportCache read_header(const renderer::ImageFile& file, const std::string& name) {
  const Header header(file.attributes, name);
  if (header.get<std::string>("kind") != "transport cache")
    throw Error({name, "header", "not a transport cache", kNotACache});
  if (const int version = header.get<int>("format_version"); version != kFormatVersion) {
    throw Error({name, "header", fmt::format("cache format {}", version),
                 fmt::format("format {}: bake again", kFormatVersion)});
  }
  TransportCache cache;
  cache.grid = read_grid(header, name);
  cache.receiver_count = std::size_t(file.image.width);
  cache.scene_fingerprint = header.get<std::string>("scene_fingerprint");
  cache.receiver_fingerprint = header.get<std::string>("receiver_fingerprint");
  cache.settings.samples = header.get<int>("samples");
  cache.settings.bounces = header.get<int>("bounces");
  cache.settings.seed = header.parse<std::uint64_t>(header.get<std::string>("seed"), "seed");
  cache.settings.materials = header.get<std::string>("materials");
  cache.indirect_relative_error = double(header.get<float>("indirect_relative_error"));
  if (std::size_t(file.image.height) != cache.grid.positions.size()) {
    throw Error(
        {name, "", fmt::format("{} rows for {} lights", file.image.height, cache.grid.positions.size()), kNotACache});
  }
  return cache;
}

std::array<int, 4> find_channels(const Image& image, const std::string& name) {
  std::array<int, 4> channels{};
  for (int c = 0; c < 4; ++c) {
    channels[c] = image.find_channel(kChannels[c]);
    if (channels[c] < 0) throw Error({name, "", "no channel " + kChannels[c], kNotACache});
  }
  return channels;
}

}  // namespace

void save_transport_cache(const TransportCache& cache, const std::filesystem::path& path) {
  Image image = renderer::make_image(int(cache.receiver_count), int(cache.grid.positions.size()), kChannels);
  const float scale = indirect_scale(cache);
  for (std::size_t i = 0; i < cache.visibility.size(); ++i) {
    float* pixel = &image.pixels[4 * i];
    pixel[0] = cache.visibility[i] != 0 ? 1.0F : 0.0F;
    for (int c = 0; c < 3; ++c) pixel[c + 1] = scale * cache.indirect[i][c];
  }
  save_image(image, path, renderer::PixelType::kHalf, header_of(cache, scale));
}

TransportCache load_transport_cache_header(const std::filesystem::path& path) {
  return read_header(renderer::load_image_header(path), path.string());
}

TransportCache load_transport_cache(const std::filesystem::path& path,
                                    std::optional<std::span<const std::size_t>> receivers) {
  const renderer::ImageFile file = renderer::load_image(path);
  const std::string name = path.string();
  TransportCache cache = read_header(file, name);
  const std::array<int, 4> channels = find_channels(file.image, name);
  const float scale = Header(file.attributes, name).get<float>("indirect_scale");
  if (!(scale > 0) || !std::isfinite(scale))
    throw Error({name, "header", "chiaro:indirect_scale is not positive", kNotACache});
  const std::size_t lights = cache.grid.positions.size();
  const std::size_t columns = receivers ? receivers->size() : cache.receiver_count;
  cache.visibility.resize(lights * columns);
  cache.indirect.resize(lights * columns);
  for (std::size_t light = 0; light < lights; ++light) {
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t receiver = receivers ? (*receivers)[i] : i;
      const float* pixel = file.image.at(int(receiver), int(light));
      const Vec3f indirect = Vec3f{pixel[channels[1]], pixel[channels[2]], pixel[channels[3]]} / scale;
      if (!is_finite(indirect))
        throw Error({name, fmt::format("light {}, receiver {}", light, receiver), "not a finite value", kNotACache});
      cache.visibility[light * columns + i] = pixel[channels[0]] > 0.5F ? 1 : 0;
      cache.indirect[light * columns + i] = indirect;
    }
  }
  cache.receiver_count = columns;
  return cache;
}

}  // namespace chiaro::inverse
