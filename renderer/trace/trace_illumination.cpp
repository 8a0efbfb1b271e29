#include "renderer/trace/trace_illumination.h"

#include <array>

#include "renderer/trace/path_tracer.h"

namespace chiaro::renderer {
namespace {

// Samples are taken in this many batches, each scrambled by itself, so that their spread tells the error of the mean
// although the samples within a batch are stratified.
constexpr int kBatches = 4;

// Each punctual light is asked once per point, and not one per path, where they are no more than so many per path.
constexpr std::size_t kLightsPerPath = 4;

struct Estimate {
  Vec3f value, standard_error;
};

Vec3f batch_mean(const PathTracer& paths, const SurfaceSample& at, bool with_punctual, std::uint64_t seed,
                 std::uint32_t stream, int samples) {
  PathLight light;
  for (int i = 0; i < samples; ++i) {
    Sampler sampler(seed, stream, std::uint32_t(i));
    paths.add_illumination(at.position, at.normal, with_punctual, sampler, light);
  }
  return (light.direct + light.indirect) / float(samples);
}

Estimate estimate(const PathTracer& paths, const SurfaceSample& at, const TraceOptions& options, bool with_punctual,
                  std::uint32_t stream) {
  PathLight punctual;
  Sampler sampler(options.seed, stream, 0);
  if (!with_punctual) paths.add_punctual_illumination(at.position, at.normal, sampler, punctual);
  const bool noisy = options.bounces != 0 || with_punctual || paths.has_emission();
  if (!noisy) return {punctual.direct, {}};

  const int batches = std::min(kBatches, options.samples);
  std::array<Vec3f, kBatches> means;
  Vec3f mean;
  for (int b = 0; b < batches; ++b) {
    const int count = options.samples / batches + (b < options.samples % batches ? 1 : 0);
    const std::uint64_t seed = seed_of_batch(options.seed, std::uint64_t(b) + 1);
    means[b] = batch_mean(paths, at, with_punctual, seed, stream, count);
    mean += means[b] / float(batches);
  }
  Vec3f variance;
  for (int b = 0; b < batches; ++b) variance += (means[b] - mean) * (means[b] - mean);
  if (batches > 1) variance = variance / float(batches * (batches - 1));
  return {punctual.direct + mean, {std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)}};
}

}  // namespace

Illumination trace_illumination(const RayTracer& tracer, std::span<const SurfaceSample> points, const Lights& lights,
                                const TraceOptions& options, const Control& control) {
  const PathTracer paths(tracer, lights, options);
  const bool with_punctual =
      has_blended_surfaces(tracer.scene()) ||
      lights.size() > std::max(LightSelection::kFew, kLightsPerPath * std::size_t(options.samples));
  Illumination result;
  result.value.resize(points.size());
  result.standard_error.resize(points.size());
  constexpr std::size_t kBlock = 64;
  parallel_for((points.size() + kBlock - 1) / kBlock, "illumination", control, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(points.size(), (block + 1) * kBlock); ++i) {
      const Estimate e = estimate(paths, points[i], options, with_punctual, std::uint32_t(i));
      result.value[i] = e.value;
      result.standard_error[i] = e.standard_error;
    }
  });
  return result;
}

double relative_standard_error(const Illumination& illumination) {
  double error = 0, value = 0;
  for (std::size_t i = 0; i < illumination.value.size(); ++i) {
    error += length_squared(illumination.standard_error[i]);
    value += length_squared(illumination.value[i]);
  }
  return value > 0 ? std::sqrt(error / value) : 0;
}

}  // namespace chiaro::renderer
