#include "inverse/transport/bake.h"

#include <numeric>

#include "inverse/transport/gather_operator.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::seconds_since;
using renderer::SurfaceSample;

// Entries on which the indirect part is held against the path tracer.
constexpr std::size_t kCheckedLights = 6, kCheckedReceivers = 256;
constexpr int kCheckSamples = 256;

std::size_t bake_visibility(const RayTracer& tracer, const Receivers& receivers, TransportCache& cache,
                            const renderer::Control& control) {
  const std::size_t lights = cache.grid.positions.size();
  std::vector<std::size_t> rays(lights, 0);
  renderer::parallel_for(lights, "direct", control, [&](std::size_t light) {
    const Vec3f position = cache.grid.positions[light];
    std::uint8_t* visibility = &cache.visibility[light * cache.receiver_count];
    for (std::size_t i = 0; i < cache.receiver_count; ++i) {
      const SurfaceSample& at = receivers.samples[i];
      if (dot(position - at.position, at.normal) <= 0) continue;
      const Vec3f from = renderer::offset_point(at.position, at.normal);
      visibility[i] = tracer.occluded_between(from, position, std::uint32_t(light * 0x9e3779b9U + i)) ? 0 : 1;
      ++rays[light];
    }
  });
  return std::accumulate(rays.begin(), rays.end(), std::size_t{0});
}

void bake_indirect(const RayTracer& tracer, const GatherOperator& gather, TransportCache& cache,
                   const renderer::Control& control) {
  const std::vector<Vec3f>& lights = cache.grid.positions;
  const std::size_t blocks = (lights.size() + kLightBlock - 1) / kLightBlock;
  renderer::parallel_for(blocks, "indirect", control, [&](std::size_t block) {
    const std::size_t first = block * kLightBlock, count = std::min<std::size_t>(kLightBlock, lights.size() - first);
    const std::vector<LightBlock> columns =
        indirect_illumination(tracer, gather, std::span(lights).subspan(first, count));
    for (std::size_t l = 0; l < count; ++l) {
      Vec3f* out = &cache.indirect[(first + l) * cache.receiver_count];
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto& channel = columns[i].channel;
        out[i] = {channel[0][l], channel[1][l], channel[2][l]};
      }
    }
  });
}

// Relative L2 distance of the baked indirect part from path-traced values, the latter's own noise taken off.
double measure_indirect_error(const RayTracer& tracer, const Receivers& receivers, const TransportCache& cache,
                              const renderer::Control& control) {
  const std::size_t lights = cache.grid.positions.size(), light_count = std::min(kCheckedLights, lights);
  const std::size_t receiver_count = std::min(kCheckedReceivers, receivers.size());
  std::vector<std::size_t> chosen;
  std::vector<SurfaceSample> samples;
  for (std::size_t i = 0; i < receiver_count; ++i) {
    chosen.push_back((2 * i + 1) * receivers.size() / (2 * receiver_count));
    samples.push_back(receivers.samples[chosen.back()]);
  }
  double difference = 0, noise = 0, reference = 0;
  for (std::size_t k = 0; k < light_count; ++k) {
    const std::size_t light = (2 * k + 1) * lights / (2 * light_count);
    const renderer::Lights unity{renderer::PointLight{"", cache.grid.positions[light], {1, 1, 1}}};
    renderer::TraceOptions options{kCheckSamples, cache.settings.bounces, cache.settings.seed + 77 + k, false};
    const auto all = renderer::trace_illumination(tracer, samples, unity, options, control);
    options.bounces = 0;
    const auto direct = renderer::trace_illumination(tracer, samples, unity, options);
    for (std::size_t i = 0; i < receiver_count; ++i) {
      const Vec3f traced = all.value[i] - direct.value[i];
      difference += length_squared(cache.indirect[light * cache.receiver_count + chosen[i]] - traced);
      noise += length_squared(all.standard_error[i]);
      reference += length_squared(traced);
    }
  }
  return reference > 0 ? std::sqrt(std::max(0.0, difference - noise) / reference) : 0;
}

}  // namespace

BakeResult bake(const RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                const BakeSettings& settings, const renderer::Control& control) {
  BakeResult result;
  TransportCache& cache = result.cache;
  cache.grid = grid;
  cache.receiver_count = receivers.size();
  cache.visibility.assign(grid.positions.size() * receivers.size(), 0);
  cache.indirect.assign(grid.positions.size() * receivers.size(), Vec3f{});
  cache.scene_fingerprint = renderer::fingerprint(tracer.scene());
  cache.receiver_fingerprint = fingerprint(receivers);
  cache.settings = settings;

  auto start = std::chrono::steady_clock::now();
  result.summary.shadow_rays = bake_visibility(tracer, receivers, cache, control);
  result.summary.direct_seconds = seconds_since(start);
  if (settings.bounces == 0) return result;

  start = std::chrono::steady_clock::now();
  const GatherOptions gather_options{.samples = settings.samples, .bounces = settings.bounces, .seed = settings.seed};
  const GatherOperator gather = make_gather_operator(tracer, receivers.samples, gather_options, control);
  bake_indirect(tracer, gather, cache, control);
  result.summary.gather_rays = gather.ray_count;
  result.summary.gather_points = gather.points.size();
  result.summary.indirect_seconds = seconds_since(start);

  start = std::chrono::steady_clock::now();
  cache.indirect_relative_error = measure_indirect_error(tracer, receivers, cache, control);
  result.summary.check_seconds = seconds_since(start);
  return result;
}

}  // namespace chiaro::inverse
