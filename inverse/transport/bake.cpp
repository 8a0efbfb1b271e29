#include "inverse/transport/bake.h"

#include <atomic>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "inverse/numerics/median.h"
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
constexpr std::size_t kLeastRecords = 64, kMostRecords = 4096, kLeastLights = 64;
constexpr double kMostRays = 16;  // of a record, over those asked for per receiver

// Metres across the rooms that lights stand in, however large the ground outside is: about a diagonal.
float size_around(const RayTracer& tracer, const LightGrid& grid) {
  constexpr std::size_t kLights = 256;
  constexpr float kDiagonal = 3.5F;  // over the mean distance of walls
  const FreeSpace space(tracer);
  std::vector<double> distances;
  for (const std::size_t light : evenly_spread(grid.positions.size(), kLights)) {
    const double distance = space.mean_distance(grid.positions[light]);
    if (std::isfinite(distance)) distances.push_back(distance);
  }
  const float scene = tracer.bounds().diagonal();
  return distances.empty() ? scene : std::min(scene, kDiagonal * float(numerics::median(std::move(distances))));
}

TransportCache header_of(const RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                         const BakeSettings& settings) {
  TransportCache header;
  header.grid = grid;
  header.receiver_count = receivers.size();
  header.scene_fingerprint = renderer::fingerprint(tracer.scene());
  header.receiver_fingerprint = fingerprint(receivers);
  header.settings = settings;
  header.indirect_scale = indirect_scale_for(size_around(tracer, grid));
  return header;
}

std::size_t round_down(double value, std::size_t step, std::size_t least, std::size_t most) {
  const double steps = std::clamp(value / double(step), 0.0, double(most));
  return std::clamp(std::size_t(steps) * step, least, most);
}

// Rays of a record: about as many altogether as asked for.
int rays_of_record(int samples, std::size_t receivers, std::size_t records) {
  return int(std::min(kMostRays, double(receivers) / double(std::max<std::size_t>(1, records))) * samples);
}

void put_into(TransportCache& cache, const TransportBlock& block) {
  for (std::size_t l = 0; l < block.light_count; ++l) {
    const std::size_t from = l * block.receiver_count;
    const std::size_t to = (block.first_light + l) * cache.receiver_count + block.first_receiver;
    std::copy_n(&block.visibility[from], block.receiver_count, &cache.visibility[to]);
    std::copy_n(&block.indirect[from], block.receiver_count, &cache.indirect[to]);
  }
}

}  // namespace

Baker::Baker(const RayTracer& tracer, const Receivers& receivers, const LightGrid& grid, const BakeSettings& settings,
             double memory, const renderer::Control& control)
    : tracer_(tracer),
      receivers_(receivers),
      header_(header_of(tracer, receivers, grid, settings)),
      options_{.samples = settings.samples, .bounces = settings.bounces, .seed = settings.seed} {
  auto start = std::chrono::steady_clock::now();
  if (settings.bounces != 0) {
    require_memory(memory, bytes_to_make_gather_points(options_));
    records_ = choose_irradiance_records(tracer, receivers.samples, options_.seed + 4, control);
    gather_ = make_gather_points(tracer, receivers.samples, options_, control);
    options_.samples = rays_of_record(settings.samples, receivers.size(), records_.receivers.size());
    summary_.records = records_.receivers.size();
    summary_.gather_rays = gather_.ray_count;
    summary_.gather_points = gather_.points.size();
  }
  summary_.indirect_seconds = seconds_since(start);
  set_memory(memory);
  if (settings.bounces == 0) return;
  start = std::chrono::steady_clock::now();
  header_.indirect_relative_error = measure_indirect_error(control.without_progress());
  summary_.check_seconds = seconds_since(start);
}

void Baker::require_memory(double memory, double least) const {
  if (memory >= least) return;
  throw renderer::Error({tracer_.scene().path, "option --memory",
                         fmt::format("leaves the bake {:.0f} MB beside the scene", std::max(0.0, memory) / 1e6),
                         fmt::format("{:.0f} MB more, or fewer --samples", std::ceil((least - memory) / 1e6))});
}

// Of gather points and of records, which a band has its own list of.
double Baker::bytes_kept() const {
  const double samples = double(gather_.points.size() + gather_.cell_samples.size()) * sizeof(renderer::SurfaceSample);
  const double bounces = double(gather_.interreflection.one_bounce.entry_count()) * sizeof(SparseTransport::Entry);
  const double records = double(records_.shares.size()) * sizeof(IrradianceRecords::Share) +
                         double(records_.share_start.size() + records_.receivers.size()) * sizeof(std::size_t);
  return samples + bounces + 2 * records;
}

// What is worked on at once, beside the illumination of the records by a band of lights: a third for each.
void Baker::set_memory(double memory) {
  memory -= bytes_kept();
  const double records = double(records_.receivers.size()),
               band = double(std::min(kBand, header_.grid.positions.size()));
  const double per_value = double(sizeof(LightBlock)) / kLightBlock;
  const double per_receiver = kBytesPerEntry * double(kBand);
  const double per_record = records > 0 ? double(options_.samples) * sizeof(SparseTransport::Entry) : 1;
  const double per_light = double(gather_.points.size()) * per_value;
  const double least = std::max({per_receiver * kLeastReceivers, per_record * kLeastRecords, per_light * kLeastLights});
  const double beside = records * band * per_value, each = (memory - beside) / 3;
  require_memory(memory, beside + 3 * least);
  receivers_at_once_ = round_down(each / per_receiver, kLeastReceivers, kLeastReceivers, kMostReceivers);
  records_at_once_ = round_down(each / per_record, kLeastRecords, kLeastRecords, kMostRecords);
  lights_at_once_ = round_down(each / std::max(1.0, per_light), kLeastLights, kLeastLights, kBand);
  keeps_rows_ = per_record * records <= each;
}

SparseTransport Baker::trace_rows(std::span<const std::size_t> receivers, const renderer::Control& control) const {
  return trace_receiver_rows(tracer_, gather_, receivers_.samples, receivers, options_, control);
}

// Relative L2 distance of the indirect part from path-traced values, the latter's own noise taken off, and no less than
// the standard error of that noise, below which it is not known.
double Baker::measure_indirect_error(const renderer::Control& control) {
  const std::vector<std::size_t> lights = evenly_spread(header_.grid.positions.size(), kCheckedLights);
  const std::vector<std::size_t> chosen = evenly_spread(receivers_.size(), kCheckedReceivers);
  const std::vector<SurfaceSample> samples = select_receivers(receivers_, chosen).samples;
  std::vector<LightBlock> indirect(chosen.size());
  std::vector<Vec3f> positions;
  for (const std::size_t light : lights) positions.push_back(header_.grid.positions[light]);
  if (!gather_.points.empty()) {
    const IrradianceRecords records = records_of(records_, chosen);
    std::vector<LightBlock> illumination(records.receivers.size());
    multiply(trace_rows(records.receivers, control),
             illumination_of_gather_points(tracer_, gather_, positions, control), illumination);
    for (std::size_t i = 0; i < chosen.size(); ++i) indirect[i] = interpolate(records, i, illumination);
  }
  double difference = 0, noise = 0, reference = 0;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const renderer::Lights unity{renderer::PointLight{"", positions[k], {1, 1, 1}}};
    renderer::TraceOptions options{kCheckSamples, header_.settings.bounces, header_.settings.seed + 77 + k, false};
    const auto all = renderer::trace_illumination(tracer_, samples, unity, options, control);
    options.bounces = 0;
    const auto direct = renderer::trace_illumination(tracer_, samples, unity, options, control);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const auto& c = indirect[i].channel;
      const Vec3f traced = all.value[i] - direct.value[i];
      difference += squared_norm(Vec3f{c[0][k], c[1][k], c[2][k]} - traced);
      noise += squared_norm(all.standard_error[i]);
      reference += squared_norm(traced);
    }
  }
  const double least = noise * std::sqrt(2 / double(3 * lights.size() * chosen.size()));
  return reference > 0 ? std::sqrt(std::max(difference - noise, least) / reference) : 0;
}

void Baker::set_receivers(std::size_t first, std::size_t last) {
  if (first == first_receiver_ && last == last_receiver_) return;
  first_receiver_ = first, last_receiver_ = last;
  rows_.clear();
  if (gather_.points.empty()) return;
  std::vector<std::size_t> receivers(last - first);
  std::iota(receivers.begin(), receivers.end(), first);
  needed_ = records_of(records_, receivers);
}

void Baker::set_lights(std::size_t first, std::size_t count, const renderer::Control& control) {
  const auto start = std::chrono::steady_clock::now();
  illumination_.assign((count + kLightBlock - 1) / kLightBlock, std::vector<LightBlock>(needed_.receivers.size()));
  for (std::size_t light = 0; light < count; light += lights_at_once_) {
    gather_at_records(first + light, std::min(lights_at_once_, count - light), &illumination_[light / kLightBlock],
                      control);
    if (control.report) control.report("gather", double(std::min(light + lights_at_once_, count)) / double(count));
  }
  summary_.indirect_seconds += seconds_since(start);
}

// Into illumination[0], illumination[1] …, a block of lights each.
void Baker::gather_at_records(std::size_t first, std::size_t count, std::vector<LightBlock>* illumination,
                              const renderer::Control& control) {
  const renderer::Control quiet = control.without_progress();
  std::vector<std::vector<LightBlock>> of_points((count + kLightBlock - 1) / kLightBlock);
  renderer::parallel_for(of_points.size(), "", quiet, [&](std::size_t block) {
    const std::size_t at = block * kLightBlock;
    const auto lights =
        std::span(header_.grid.positions).subspan(first + at, std::min<std::size_t>(kLightBlock, count - at));
    of_points[block] = illumination_of_gather_points(tracer_, gather_, lights, quiet);
  });
  const std::size_t records = needed_.receivers.size();
  for (std::size_t record = 0, part = 0; record < records; record += records_at_once_, ++part) {
    const std::size_t some = std::min(records_at_once_, records - record);
    if (!keeps_rows_) rows_.clear(), part = 0;
    if (part == rows_.size()) {
      rows_.push_back(trace_rows(std::span(needed_.receivers).subspan(record, some), quiet));
      summary_.gather_rays += some * std::size_t(options_.samples);
    }
    renderer::parallel_for(of_points.size(), "", quiet, [&](std::size_t block) {
      multiply(rows_[part], of_points[block], std::span(illumination[block]).subspan(record, some));
    });
  }
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
  renderer::parallel_for(illumination_.size(), "", control, [&](std::size_t part) {
    const std::size_t first = part * kLightBlock;
    const std::size_t count = std::min<std::size_t>(kLightBlock, block.light_count - first);
    for (std::size_t i = 0; i < block.receiver_count; ++i) {
      const LightBlock at = interpolate(needed_, block.first_receiver + i - first_receiver_, illumination_[part]);
      for (std::size_t l = 0; l < count; ++l) {
        block.indirect[(first + l) * block.receiver_count + i] = {at.channel[0][l], at.channel[1][l], at.channel[2][l]};
      }
    }
  });
  summary_.indirect_seconds += seconds_since(start);
}

void Baker::bake(std::size_t first, std::size_t last, Place start,
                 const std::function<void(const TransportBlock&)>& visit, const renderer::Control& control) {
  const renderer::Control quiet = control.without_progress();
  set_receivers(first, last);
  const std::size_t lights = header_.grid.positions.size();
  // Of a band of lights, the gathering of indirect light counts as the first part.
  const double gathering = gather_.points.empty() ? 0 : 0.5;
  for (std::size_t light = start.light; light < lights; light += kBand) {
    const std::size_t count = std::min(kBand, lights - light);
    std::size_t receiver = light == start.light ? std::max(first, start.receiver) : first;
    const auto report = [&](double gathered) {
      const double done = gathering * gathered + (1 - gathering) * double(receiver - first) / double(last - first);
      if (control.report) control.report("bake", (double(light) + done * double(count)) / double(lights));
    };
    renderer::Control of_gathering = quiet;
    of_gathering.report = [&](std::string_view, double gathered) { report(gathered); };
    if (!gather_.points.empty()) set_lights(light, count, of_gathering);
    while (receiver < last) {
      TransportBlock block;
      block.first_light = light, block.light_count = count;
      block.first_receiver = receiver, block.receiver_count = std::min(receivers_at_once_, last - receiver);
      block.resize();
      fill_direct(block, quiet);
      fill_indirect(block, quiet);
      visit(block);
      receiver += block.receiver_count;
      report(1);
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
