#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "cli/bake_summary.h"
#include "cli/inspect.h"
#include "cli/memory.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/core/error.h"
#include "renderer/image/image_file.h"

namespace chiaro::cli {
namespace {

using inverse::TransportCache;
using renderer::Image;

struct ChannelFigures {
  double min = 0, max = 0, mean = 0;
  std::size_t nan = 0, infinite = 0;
};

// Over the finite values.
ChannelFigures channel_figures(const Image& image, int channel) {
  ChannelFigures figures;
  std::size_t count = 0;
  const std::size_t stride = image.channel_names.size();
  for (std::size_t i = std::size_t(channel); i < image.pixels.size(); i += stride) {
    const double value = double(image.pixels[i]);
    figures.nan += std::isnan(value);
    figures.infinite += std::isinf(value);
    if (!std::isfinite(value)) continue;
    figures.min = count == 0 ? value : std::min(figures.min, value);
    figures.max = count == 0 ? value : std::max(figures.max, value);
    figures.mean += value;
    ++count;
  }
  if (count > 0) figures.mean /= double(count);
  return figures;
}

void add_channels(Inspection& inspection, const Image& image) {
  JsonList channels;
  std::size_t nan = 0;
  for (int c = 0; c < image.channel_count(); ++c) {
    const ChannelFigures f = channel_figures(image, c);
    const std::string& name = image.channel_names[std::size_t(c)];
    channels.emplace_back(JsonObject{
        {"name", name}, {"min", f.min}, {"max", f.max}, {"mean", f.mean}, {"nan", f.nan}, {"infinite", f.infinite}});
    inspection.rows.emplace_back(name, fmt::format("{:.4g} to {:.4g}, mean {:.4g}, {} NaN, {} infinite", f.min, f.max,
                                                   f.mean, f.nan, f.infinite));
    nan += f.nan;
  }
  inspection.summary.emplace_back("channels", channels);
  inspection.summary.emplace_back("nan_count", nan);
}

struct AttributeJson {
  Json operator()(int v) const { return v; }
  Json operator()(float v) const { return v; }
  Json operator()(const std::string& v) const { return v; }
  template <std::size_t N>
  Json operator()(const std::array<float, N>& v) const {
    return JsonList(v.begin(), v.end());
  }
};

void add_attributes(Inspection& inspection, const renderer::Attributes& attributes) {
  JsonObject ours;
  for (const auto& [name, value] : attributes) {
    const Json json = std::visit(AttributeJson{}, value);
    ours.emplace_back(name, json);
    if (!name.starts_with("chiaro:")) continue;
    const auto* text = std::get_if<std::string>(&value);
    const std::string shown = text != nullptr ? *text : one_line(json_text(json));
    inspection.rows.emplace_back(name.substr(std::string("chiaro:").size()), shown);
  }
  inspection.summary.emplace_back("attributes", ours);
}

Inspection inspect_frame(const std::string& file) {
  const renderer::ImageFile picture = renderer::load_image(file);
  const auto is_ours = [](const auto& attribute) { return attribute.first == "chiaro:version"; };
  const bool frame = std::any_of(picture.attributes.begin(), picture.attributes.end(), is_ours);
  Inspection inspection = start_inspection(frame ? "frame" : "image", file);
  const Image& image = picture.image;
  inspection.rows.emplace_back("size", fmt::format("{} x {} pixels", image.width, image.height));
  inspection.summary.emplace_back("width", image.width);
  inspection.summary.emplace_back("height", image.height);
  add_channels(inspection, image);
  add_attributes(inspection, picture.attributes);
  return inspection;
}

void add_cache_header(Inspection& inspection, const TransportCache& cache) {
  const inverse::LightGrid& grid = cache.grid;
  inspection.add("receivers", cache.receiver_count, "receivers", fmt::format("{}", cache.receiver_count));
  inspection.add("lights", grid.positions.size(), "lights", text_of_lights(grid));
  inspection.add("grid", grid_summary(grid, grid.positions.size()), "grid",
                 fmt::format("from {} m, {} m apart", text_of_vector(grid.origin), text_of_vector(grid.spacing)));
  inspection.add("samples", cache.settings.samples, "samples",
                 fmt::format("{} gather rays per receiver", cache.settings.samples));
  inspection.add(
      "bounces", cache.settings.bounces, "bounces",
      cache.settings.bounces < 0 ? "until they no longer matter" : fmt::format("{}", cache.settings.bounces));
  inspection.add("seed", fmt::format("{}", cache.settings.seed), "seed", fmt::format("{}", cache.settings.seed));
  inspection.add("materials", cache.settings.materials, "materials", cache.settings.materials);
  inspection.add("indirect_relative_error", cache.indirect_relative_error, "error of indirect light",
                 text_of_percent(cache.indirect_relative_error));
  inspection.add("scene_fingerprint", cache.scene_fingerprint, "scene fingerprint", cache.scene_fingerprint);
  inspection.add("receiver_fingerprint", cache.receiver_fingerprint, "receiver fingerprint",
                 cache.receiver_fingerprint);
}

// The entries too, so that a truncated cache is told from a whole one.
void add_cache_entries(Inspection& inspection, const std::string& file) {
  const TransportCache cache = inverse::load_transport_cache(file);
  const double entries = double(cache.visibility.size());
  const double visible = double(std::count(cache.visibility.begin(), cache.visibility.end(), 1)) / entries;
  double sum = 0;
  for (const renderer::Vec3f value : cache.indirect) sum += double(renderer::luminance(value));
  inspection.add("visible_fraction", visible, "visible", text_of_percent(visible) + " of light and receiver pairs");
  inspection.add("mean_indirect", sum / entries, "mean indirect", fmt::format("{:.4g} cd/m² per cd", sum / entries));
}

bool fits_in_memory(const TransportCache& header) {
  constexpr double kBytesPerEntry = 4 * sizeof(float) + sizeof(renderer::Vec3f) + 1;
  return kBytesPerEntry * double(header.receiver_count) * double(header.grid.positions.size()) < memory_bytes() / 2;
}

// Its last entry tells whether it is whole.
void require_whole_part(inverse::TransportCacheReader& part, const std::string& file) {
  inverse::TransportBlock last{.first_light = part.header().grid.positions.size() - 1,
                               .light_count = 1,
                               .first_receiver = part.last_receiver() - 1,
                               .receiver_count = 1,
                               .visibility = {},
                               .indirect = {}};
  if (!part.read(last)) throw renderer::Error({file, "", "cut short or damaged", "a whole part of a cache"});
}

// Absent: it is a cache, whole or not.
std::optional<Inspection> inspect_part(const std::string& file) {
  if (!renderer::ExrTileReader::is_tiled(file)) return std::nullopt;
  inverse::TransportCacheReader part(file);
  const std::size_t first = part.first_receiver(), last = part.last_receiver(), all = part.header().receiver_count;
  if (first == 0 && last == all) return std::nullopt;
  require_whole_part(part, file);
  Inspection inspection = start_inspection("part of a transport cache", file);
  inspection.add("part", JsonObject{{"first_receiver", first}, {"last_receiver", last - 1}}, "part",
                 fmt::format("receivers {} to {} of {}, for `chiaro merge`", first, last - 1, all));
  add_cache_header(inspection, part.header());
  return inspection;
}

Inspection inspect_cache(const std::string& file) {
  if (auto part = inspect_part(file)) return *std::move(part);
  const TransportCache header = inverse::load_transport_cache_header(file);
  Inspection inspection = start_inspection("transport cache", file);
  add_cache_header(inspection, header);
  if (fits_in_memory(header)) {
    add_cache_entries(inspection, file);
  } else {
    inspection.warnings.push_back(file + ": too large to look at more than its header");
  }
  return inspection;
}

}  // namespace

Inspection inspect_picture(const std::string& file) {
  const renderer::ImageFile header = renderer::load_image_header(file);
  return header.image.find_channel("visibility") >= 0 ? inspect_cache(file) : inspect_frame(file);
}

}  // namespace chiaro::cli
