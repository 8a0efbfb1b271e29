#include "renderer/trace/trace_illumination.h"

#include <algorithm>
#include <array>

#include "renderer/trace/path_tracer.h"

namespace chiaro::renderer {
namespace {

// Samples are taken in this many batches, each scrambled by itself, so that their spread tells the error of the mean
// although the samples within a batch are stratified.
constexpr int kBatches = 4;

// Each punctual light is asked once per point, and not one per path, where they are no more than so many per path.
constexpr std::size_t kLightsPerPath = 4;

// No receiver shows a lamp mirrored in polish: it gets what polish throws onto it, which is blurred at once.
TraceOptions with_wide_highlights(TraceOptions options) {
  options.wide_highlights = true;
  return options;
}

// How the illumination of each of many points is sampled.
struct Sampling {
  Sampling(const RayTracer& tracer, const Lights& lights, const TraceOptions& options_, const Control& control_)
      : control(control_),
        paths(tracer, lights, with_wide_highlights(options_)),
        options(options_),
        with_punctual(has_blended_surfaces(tracer.scene()) ||
                      lights.size() > std::max(LightSelection::kFew, kLightsPerPath * std::size_t(options.samples))),
        noisy(options.bounces != 0 || with_punctual || paths.has_emission()),
        batches(std::min(kBatches, options.samples)) {}

  bool tells_error() const { return !noisy || batches > 1; }
  int samples_of(int batch) const { return options.samples / batches + (batch < options.samples % batches ? 1 : 0); }

  const Control& control;
  PathTracer paths;
  TraceOptions options;
  bool with_punctual;  // of direct light by the paths, and not apart from them
  bool noisy;          // there is light that takes paths
  int batches;
};

struct Estimate {
  Vec3f value, standard_error;
};

void add_exact(const Sampling& sampling, const PathTracer::Receiver& at, std::uint32_t stream, PathLight& light) {
  Sampler sampler(sampling.options.seed, stream, 0);
  if (!sampling.with_punctual) sampling.paths.add_punctual_illumination(at, sampler, light);
}

// Of very many paths, what floats would round away.
struct Sums {
  Vec3d all{};
  std::vector<Vec3d> per_light;

  // Moves what `light` has over.
  void take(PathLight& light) {
    all += Vec3d(light.direct + light.indirect);
    for (std::size_t l = 0; l < per_light.size(); ++l) per_light[l] += Vec3d(light.per_light[l]);
    light.direct = light.indirect = {};
    std::fill(light.per_light.begin(), light.per_light.end(), Vec3f{});
  }
};

Sums sum_of_batch(const Sampling& sampling, const PathTracer::Receiver& at, int batch, std::uint32_t stream,
                  std::size_t sources) {
  constexpr int kInFloats = 64;  // paths
  const std::uint64_t seed = seed_of_batch(sampling.options.seed, std::uint64_t(batch) + 1);
  PathLight light;
  light.per_light.assign(sources, {});
  Sums sums{{}, std::vector<Vec3d>(sources)};
  const int samples = sampling.samples_of(batch);
  for (int i = 0; i < samples; ++i) {
    sampling.control.stop_if_requested();  // a point may have millions
    Sampler sampler(seed, stream, std::uint32_t(i));
    sampling.paths.add_illumination(at, sampling.with_punctual, sampler, light);
    if (i % kInFloats == kInFloats - 1 || i == samples - 1) sums.take(light);
  }
  return sums;
}

// per_light: also what each source brings, all samples together; it has their number, or none.
Estimate estimate(const Sampling& sampling, const SurfaceSample& point, std::uint32_t stream,
                  std::vector<Vec3f>& per_light) {
  const Vec3f in_front = offset_point(point.position, point.normal);
  const PathTracer::Receiver at{point.on_surface(), point.normal, point.stand_off, sampling.paths.media_at(in_front)};
  PathLight exact;
  exact.per_light.assign(per_light.size(), {});
  add_exact(sampling, at, stream, exact);
  per_light = exact.per_light;
  if (!sampling.noisy) return {exact.direct, {}};

  const int batches = sampling.batches;
  std::array<Vec3f, kBatches> means;
  Vec3f mean;
  for (int b = 0; b < batches; ++b) {
    const Sums sums = sum_of_batch(sampling, at, b, stream, per_light.size());
    const double samples = sampling.samples_of(b);
    means[b] = Vec3f(sums.all / samples);
    mean += means[b] / float(batches);
    for (std::size_t l = 0; l < per_light.size(); ++l) per_light[l] += Vec3f(sums.per_light[l] / (batches * samples));
  }
  Vec3f error;
  for (int c = 0; c < 3; ++c) {
    double variance = 0;
    for (int b = 0; b < batches; ++b) variance += std::pow(double(means[b][c]) - double(mean[c]), 2);
    if (batches > 1) error[c] = float(std::sqrt(variance / (batches * (batches - 1))));
  }
  return {exact.direct + mean, error};
}

Illumination sized(std::size_t points, const Sampling& sampling) {
  return {std::vector<Vec3f>(points), std::vector<Vec3f>(sampling.tells_error() ? points : 0)};
}

void store(const Estimate& estimate, std::size_t point, Illumination& all) {
  all.value[point] = estimate.value;
  if (!all.standard_error.empty()) all.standard_error[point] = estimate.standard_error;
}

template <class Function>
void for_each_point(std::size_t points, const Control& control, const Function& function) {
  constexpr std::size_t kBlock = 64;
  parallel_for((points + kBlock - 1) / kBlock, "illumination", control, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(points, (block + 1) * kBlock); ++i) function(i);
  });
}

// Standard errors of the same points with another number of samples.
std::vector<Vec3f> with_samples(const Illumination& traced, int samples, int others) {
  std::vector<Vec3f> errors = traced.standard_error;
  for (Vec3f& error : errors) error *= std::sqrt(float(samples) / float(others));
  return errors;
}

}  // namespace

Illumination trace_illumination(const RayTracer& tracer, std::span<const SurfaceSample> points, const Lights& lights,
                                const TraceOptions& options, const Control& control) {
  const Sampling sampling(tracer, lights, options, control);
  Illumination result = sized(points.size(), sampling);
  for_each_point(points.size(), control, [&](std::size_t i) {
    std::vector<Vec3f> not_taken_apart;
    store(estimate(sampling, points[i], std::uint32_t(i), not_taken_apart), i, result);
  });
  return result;
}

IlluminationByLight trace_illumination_by_light(const RayTracer& tracer, std::span<const SurfaceSample> points,
                                                const Lights& lights, const TraceOptions& options,
                                                const Control& control) {
  const Sampling sampling(tracer, lights, options, control);
  IlluminationByLight result{sized(points.size(), sampling),
                             std::vector<std::vector<Vec3f>>(lights.size(), std::vector<Vec3f>(points.size()))};
  for_each_point(points.size(), control, [&](std::size_t i) {
    std::vector<Vec3f> per_light(sampling.paths.emission_source() + 1);
    store(estimate(sampling, points[i], std::uint32_t(i), per_light), i, result.total);
    for (std::size_t l = 0; l < lights.size(); ++l) result.of_light[l][i] = per_light[l];
  });
  return result;
}

Illumination joined(Illumination first, int first_samples, const Illumination& second, int second_samples) {
  const float b = float(second_samples) / float(first_samples + second_samples), a = 1 - b;
  for (std::size_t i = 0; i < first.value.size(); ++i) first.value[i] = a * first.value[i] + b * second.value[i];
  if (first.standard_error.empty()) first.standard_error = with_samples(second, second_samples, first_samples);
  const std::vector<Vec3f> further =
      second.standard_error.empty() ? with_samples(first, first_samples, second_samples) : second.standard_error;
  for (std::size_t i = 0; i < further.size(); ++i) {
    Vec3f& error = first.standard_error[i];
    for (int c = 0; c < 3; ++c) error[c] = std::hypot(a * error[c], b * further[i][c]);
  }
  return first;
}

int samples_for_noise(int samples, double noise, double may_be, int most) {
  if (noise <= may_be) return samples;
  const double needed = std::ceil(samples * std::pow(noise / may_be, 2));  // infinite where nothing may be
  return int(std::min(needed, double(most)));
}

std::optional<double> relative_standard_error(const Illumination& illumination, std::span<const float> weight) {
  if (illumination.standard_error.empty() && !illumination.value.empty()) return std::nullopt;
  double error = 0, value = 0;
  for (std::size_t i = 0; i < illumination.value.size(); ++i) {
    const double w = weight.empty() ? 1 : double(weight[i]);
    error += w * double(squared_norm(illumination.standard_error[i]));
    value += w * double(squared_norm(illumination.value[i]));
  }
  return value > 0 ? std::sqrt(error / value) : 0;
}

}  // namespace chiaro::renderer
