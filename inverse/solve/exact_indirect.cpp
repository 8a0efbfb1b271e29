#include "inverse/solve/exact_indirect.h"

#include <algorithm>
#include <cmath>

#include "inverse/numerics/chosen_from.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr int kSamplesFactor = 4;     // gather rays per receiver, over those of the bake
constexpr int kPointsPerSample = 16;  // gather points over rays
constexpr int kPathsPerPoint = 16, kRaysPerPoint = 32;
constexpr std::size_t kPathsPerSample = 16000;       // of all lights together, over rays per receiver of the bake …
constexpr int kLeastPaths = 128, kMostPaths = 8192;  // … per light and receiver, at most …
constexpr int kFirstPart = 8;                        // … of which this part tells how many it takes …
constexpr double kNoiseBesideTarget = 0.3;           // … to so much of the target's noise

// Makes this the light's indirect illumination of the receivers, where it stands now.
void set_correction(const LightResponse& response, LightEstimate& light, const Column& indirect) {
  light.correction = indirect - response.interpolated_indirect(light.position);
  light.corrected_at = light.position;
}

renderer::PointLight unity_light(const Eigen::Vector3d& position) {
  renderer::PointLight unity;
  unity.position = to_vec3f(position);
  unity.intensity = {1, 1, 1};
  return unity;
}

int paths_of_each(std::size_t paths, std::size_t receivers) {
  return int(std::clamp(paths / receivers, std::size_t(kLeastPaths), std::size_t(kMostPaths)));
}

// What some receivers get of a unity light by bounces alone.
std::vector<Vec3f> without_direct(const LightResponse& response, const std::vector<std::size_t>& receivers,
                                  const Eigen::Vector3d& position, std::vector<Vec3f> traced) {
  const Column direct = response.direct(position);
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    for (int c = 0; c < 3; ++c) traced[k][c] -= float(direct(Eigen::Index(receivers[k]), c));
  }
  return traced;
}

GatherOptions gather_options(const BakeSettings& settings) {
  return {.samples = kSamplesFactor * settings.samples,
          .points_per_sample = kPointsPerSample,
          .paths_per_point = kPathsPerPoint,
          .rays_per_point = kRaysPerPoint,
          .bounces = settings.bounces,
          .seed = settings.seed};
}

}  // namespace

ExactIndirect::ExactIndirect(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                             const BakeSettings& settings, const renderer::Control& control)
    : tracer_(tracer),
      settings_(settings),
      gather_(make_gather_operator(tracer, receivers, gather_options(settings), control.without_progress())) {}

void ExactIndirect::correct(const LightResponse& response, LightEstimates& lights) const {
  const auto exact = indirect_illumination_by_light(tracer_, gather_, light_positions(lights));
  for (std::size_t j = 0; j < lights.size(); ++j) set_correction(response, lights[j], column_of(exact[j]));
}

void ExactIndirect::correct_by_paths(const LightResponse& response, const Observations& observations,
                                     LightEstimates& lights) const {
  const std::size_t paths = kPathsPerSample * std::size_t(settings_.samples) / std::max<std::size_t>(1, lights.size());
  const int most = paths_of_each(paths, response.receiver_count());
  for (LightEstimate& light : lights) {
    const Column traced = column_of(traced_so_well(response, observations, light, most).value);
    set_correction(response, light, traced - response.direct(light.position));
  }
}

renderer::Illumination ExactIndirect::traced_so_well(const LightResponse& response, const Observations& observations,
                                                     const LightEstimate& light, int most) const {
  const auto trace = [&](int samples, std::uint64_t seed) {
    return trace_illumination(tracer_, response.receivers(), {unity_light(light.position)},
                              {samples, settings_.bounces, seed, false});
  };
  const int first = std::max(kLeastPaths, most / kFirstPart);
  renderer::Illumination traced = trace(first, settings_.seed);
  const Column error = column_of(traced.standard_error) * light.intensity.matrix().asDiagonal();
  const double noise = (observations.sqrt_weight.asDiagonal() * error).norm() / observations.target_norm;
  const double may_be = kNoiseBesideTarget * observations.noise;
  const int more = renderer::samples_for_noise(first, noise, may_be, most) - first;
  return more > 0 ? joined(std::move(traced), first, trace(more, settings_.seed + 1), more) : traced;
}

std::vector<Vec3f> ExactIndirect::traced(const LightResponse& response, const std::vector<std::size_t>& receivers,
                                         const Eigen::Vector3d& position, std::size_t paths) const {
  const std::vector<renderer::SurfaceSample> samples = numerics::chosen_from(response.receivers(), receivers);
  const auto traced =
      trace_illumination(tracer_, samples, {unity_light(position)},
                         {paths_of_each(paths, samples.size()), settings_.bounces, settings_.seed, false});
  return without_direct(response, receivers, position, traced.value);
}

}  // namespace chiaro::inverse
