#include "inverse/transport/bake.h"

#include <atomic>
#include <limits>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::seconds_since;
using renderer::SurfaceSample;

// Entries on which the indirect part is held against the path tracer.
constexpr std::size_t kCheckedLights = 6, kCheckedReceivers = 256;
constexpr int kCheckSamples = 256;

constexpr std::size_t kBand = TransportCacheWriter::kLights;
// Of a block: whole tiles.
constexpr std::size_t kLeastReceivers = TransportCacheWriter::kMostReceivers, kMostReceivers = 16 * kLeastReceivers;
constexpr double kBytesPerEntry = 64;  // of a block, with what its writing takes

TransportCache header_of(const RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                         const BakeSettings& settings) {
  TransportCache header;
  header.grid = grid;
  header.receiver_count = receivers.size();
  header.scene_fingerprint = renderer::fingerprint(tracer.scene());
  header.receiver_fingerprint = fingerprint(receivers);
  header.settings = settings;
  header.indirect_scale = indirect_scale_for(tracer.bounds());
  return header;
}

std::size_t round_down(double value, std::size_t step, std::size_t least, std::size_t most) {
  const double steps = std::clamp(value / double(step), 0.0, double(most));
  return std::clamp(std::size_t(steps) * step, least, most);
}

void put_into(TransportCache& cache, const TransportBlock& block) {
  for (std::size_t l = 0; l < block.light_count; ++l) {
    const std::size_t from = l * block.receiver_count;
    const std::size_t to = (block.first_light + l) * cache.receiver_count + block.first_receiver;
    std::copy_n(&block.visibility[from], block.receiver_count, &cache.visibility[to]);
    std::copy_n(&block.indirect[from], block.receiver_count, &cache.indirect[to]);
  }
}

renderer::Control without_progress(const renderer::Control& control) {
  renderer::Control quiet;
  quiet.interrupted = control.interrupted;
  return quiet;
}

}  // namespace

Baker::Baker(const RayTracer& tracer, const Receivers& receivers, const LightGrid& grid, const BakeSettings& settings,
             double memory, const renderer::Control& control)
    : tracer_(tracer),
      receivers_(receivers),
      header_(header_of(tracer, receivers, grid, settings)),
      options_{.samples = settings.samples, .bounces = settings.bounces, .seed = settings.seed} {
  const double points = settings.bounces == 0 ? 0 : double(options_.samples) * options_.points_per_sample;
  const double lights = points * double(std::min(kBand, grid.positions.size())) * sizeof(LightBlock) / kLightBlock;
  const double per_receiver = kBytesPerEntry * double(kBand), rows = double(receivers.size()) * options_.samples;
  const double left = (memory - lights) / 2;
  receivers_at_once_ = round_down(left / per_receiver, kLeastReceivers, kLeastReceivers, kMostReceivers);
  keeps_rows_ = rows * sizeof(SparseTransport::Entry) <= left;
  if (left < per_receiver * kLeastReceivers) {
    const double needed = lights + 2 * per_receiver * kLeastReceivers;
    throw renderer::Error({tracer.scene().path, "option --memory",
                           fmt::format("{:.0f} MB are left for the bake", std::max(0.0, memory) / 1e6),
                           fmt::format("{:.0f} MB or more, or fewer --samples", std::ceil(needed / 1e6))});
  }
  if (settings.bounces == 0) return;
  auto start = std::chrono::steady_clock::now();
  gather_ = make_gather_points(tracer, receivers.samples, options_, control);
  summary_.gather_rays = gather_.ray_count;
  summary_.gather_points = gather_.points.size();
  summary_.indirect_seconds = seconds_since(start);
  start = std::chrono::steady_clock::now();
  header_.indirect_relative_error = measure_indirect_error(without_progress(control));
  summary_.check_seconds = seconds_since(start);
}

// Relative L2 distance of the indirect part from path-traced values, the latter's own noise taken off.
double Baker::measure_indirect_error(const renderer::Control& control) {
  const std::vector<std::size_t> lights = evenly_spread(header_.grid.positions.size(), kCheckedLights);
  const std::vector<std::size_t> chosen = evenly_spread(receivers_.size(), kCheckedReceivers);
  std::vector<SurfaceSample> samples;
  std::vector<LightBlock> indirect(chosen.size());
  std::vector<Vec3f> positions;
  for (const std::size_t i : chosen) samples.push_back(receivers_.samples[i]);
  for (const std::size_t light : lights) positions.push_back(header_.grid.positions[light]);
  if (!gather_.points.empty()) {
    const auto illumination = illumination_of_gather_points(tracer_, gather_, positions);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const auto row = trace_receiver_rows(tracer_, gather_, {&samples[i], 1}, chosen[i], options_, control);
      multiply(row, illumination, {&indirect[i], 1});
    }
  }
  double difference = 0, noise = 0, reference = 0;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const renderer::Lights unity{renderer::PointLight{"", positions[k], {1, 1, 1}}};
    renderer::TraceOptions options{kCheckSamples, header_.settings.bounces, header_.settings.seed + 77 + k, false};
    const auto all = renderer::trace_illumination(tracer_, samples, unity, options, control);
    options.bounces = 0;
    const auto direct = renderer::trace_illumination(tracer_, samples, unity, options);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const auto& c = indirect[i].channel;
      const Vec3f traced = all.value[i] - direct.value[i];
      difference += length_squared(Vec3f{c[0][k], c[1][k], c[2][k]} - traced);
      noise += length_squared(all.standard_error[i]);
      reference += length_squared(traced);
    }
  }
  return reference > 0 ? std::sqrt(std::max(0.0, difference - noise) / reference) : 0;
}

void Baker::choose_lights(std::size_t first, std::size_t count, const renderer::Control& control) {
  if (first == first_chosen_ && count == chosen_) return;
  first_chosen_ = first, chosen_ = count;
  illumination_.resize((count + kLightBlock - 1) / kLightBlock);
  renderer::parallel_for(illumination_.size(), "", control, [&](std::size_t block) {
    const std::size_t at = block * kLightBlock;
    const auto lights =
        std::span(header_.grid.positions).subspan(first + at, std::min<std::size_t>(kLightBlock, count - at));
    illumination_[block] = illumination_of_gather_points(tracer_, gather_, lights);
  });
}

const SparseTransport& Baker::rows_of(std::size_t first, std::size_t count, const renderer::Control& control) {
  for (const Rows& known : rows_) {
    if (known.first_receiver == first && known.rows.row_count() == count) return known.rows;
  }
  if (!keeps_rows_) rows_.clear();
  const auto receivers = std::span(receivers_.samples).subspan(first, count);
  rows_.push_back({first, trace_receiver_rows(tracer_, gather_, receivers, first, options_, control)});
  summary_.gather_rays += count * std::size_t(options_.samples);
  return rows_.back().rows;
}

void Baker::fill_direct(TransportBlock& block, const renderer::Control& control) {
  const auto start = std::chrono::steady_clock::now();
  std::atomic<std::size_t> rays{0};
  renderer::parallel_for(block.light_count, "", control, [&](std::size_t l) {
    const std::size_t light = block.first_light + l;
    const Vec3f position = header_.grid.positions[light];
    std::uint8_t* visibility = &block.visibility[l * block.receiver_count];
    std::size_t traced = 0;
    for (std::size_t i = 0; i < block.receiver_count; ++i) {
      const std::size_t receiver = block.first_receiver + i;
      const SurfaceSample& at = receivers_.samples[receiver];
      if (dot(position - at.position, at.normal) <= 0) continue;
      const Vec3f from = renderer::offset_point(at.position, at.normal);
      visibility[i] = tracer_.occluded_between(from, position, std::uint32_t(light * 0x9e3779b9U + receiver)) ? 0 : 1;
      ++traced;
    }
    rays += traced;
  });
  summary_.shadow_rays += rays;
  summary_.direct_seconds += seconds_since(start);
}

void Baker::fill_indirect(TransportBlock& block, const renderer::Control& control) {
  if (gather_.points.empty()) return;
  const auto start = std::chrono::steady_clock::now();
  const SparseTransport& rows = rows_of(block.first_receiver, block.receiver_count, control);
  choose_lights(block.first_light, block.light_count, control);
  renderer::parallel_for(illumination_.size(), "", control, [&](std::size_t part) {
    std::vector<LightBlock> columns(block.receiver_count);
    multiply(rows, illumination_[part], columns);
    const std::size_t first = part * kLightBlock;
    const std::size_t count = std::min<std::size_t>(kLightBlock, block.light_count - first);
    for (std::size_t l = 0; l < count; ++l) {
      Vec3f* out = &block.indirect[(first + l) * block.receiver_count];
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto& channel = columns[i].channel;
        out[i] = {channel[0][l], channel[1][l], channel[2][l]};
      }
    }
  });
  summary_.indirect_seconds += seconds_since(start);
}

void Baker::bake(std::size_t first, std::size_t last, Place start,
                 const std::function<void(const TransportBlock&)>& visit, const renderer::Control& control) {
  const renderer::Control quiet = without_progress(control);
  const std::size_t lights = header_.grid.positions.size();
  const double all = double(lights) * double(last - first);
  for (std::size_t light = start.light; light < lights; light += kBand) {
    std::size_t receiver = light == start.light ? std::max(first, start.receiver) : first;
    while (receiver < last) {
      TransportBlock block;
      block.first_light = light, block.light_count = std::min(kBand, lights - light);
      // To where a block would end that had begun at the first receiver, so that rows are found again.
      const std::size_t end = first + ((receiver - first) / receivers_at_once_ + 1) * receivers_at_once_;
      block.first_receiver = receiver, block.receiver_count = std::min(end, last) - receiver;
      block.resize();
      fill_direct(block, quiet);
      fill_indirect(block, quiet);
      visit(block);
      receiver += block.receiver_count;
      const double done = double(light) * double(last - first) + double(block.light_count) * double(receiver - first);
      if (control.report) control.report("bake", done / all);
    }
  }
}

BakeResult bake(const RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                const BakeSettings& settings, const renderer::Control& control) {
  Baker baker(tracer, receivers, grid, settings, std::numeric_limits<double>::infinity(), control);
  BakeResult result;
  result.cache = baker.header();
  result.cache.visibility.resize(grid.positions.size() * receivers.size());
  result.cache.indirect.resize(result.cache.visibility.size());
  baker.bake(
      0, receivers.size(), {}, [&](const TransportBlock& block) { put_into(result.cache, block); }, control);
  result.summary = baker.summary();
  return result;
}

}  // namespace chiaro::inverse
