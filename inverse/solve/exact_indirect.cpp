#include "inverse/solve/exact_indirect.h"

#include <algorithm>
#include <numeric>

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr int kSamplesFactor = 4;                    // gather rays per receiver, over those of the bake
constexpr int kPointsPerSample = 16;                 // gather points over rays
constexpr std::size_t kPathsPerSample = 16000;       // of all lights together, over rays per receiver of the bake …
constexpr int kLeastPaths = 128, kMostPaths = 8192;  // … per light and receiver

// Makes this the light's indirect illumination of the receivers, where it stands now.
void set_correction(const LightResponse& response, LightEstimate& light, const std::vector<Vec3f>& indirect) {
  light.correction = column_of(indirect) - response.interpolated_indirect(light.position);
  light.corrected_at = light.position;
}

GatherOptions gather_options(const BakeSettings& settings) {
  return {.samples = kSamplesFactor * settings.samples,
          .points_per_sample = kPointsPerSample,
          .bounces = settings.bounces,
          .seed = settings.seed};
}

}  // namespace

ExactIndirect::ExactIndirect(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                             const BakeSettings& settings)
    : tracer_(tracer),
      settings_(settings),
      gather_(make_gather_operator(tracer, receivers, gather_options(settings))) {}

void ExactIndirect::correct(const LightResponse& response, LightEstimates& lights, double near) const {
  std::vector<std::size_t> moved;
  std::vector<Vec3f> positions;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const bool corrected = lights[j].correction.size() > 0;
    if (corrected && near > 0 && (lights[j].position - lights[j].corrected_at).norm() <= near) continue;
    moved.push_back(j);
    positions.push_back(to_vec3f(lights[j].position));
  }
  const auto exact = indirect_illumination_by_light(tracer_, gather_, positions);
  for (std::size_t k = 0; k < moved.size(); ++k) set_correction(response, lights[moved[k]], exact[k]);
}

void ExactIndirect::correct_by_paths(const LightResponse& response, LightEstimates& lights) const {
  std::vector<std::size_t> all(response.receiver_count());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::size_t paths = kPathsPerSample * std::size_t(settings_.samples);
  for (LightEstimate& light : lights) {
    set_correction(response, light, traced(response, all, light.position, paths / lights.size()));
  }
}

std::vector<Vec3f> ExactIndirect::traced(const LightResponse& response, const std::vector<std::size_t>& receivers,
                                         const Eigen::Vector3d& position, std::size_t paths) const {
  renderer::PointLight unity;
  unity.position = to_vec3f(position);
  unity.intensity = {1, 1, 1};
  std::vector<renderer::SurfaceSample> samples;
  for (const std::size_t i : receivers) samples.push_back(response.receivers()[i]);
  const int each = std::clamp(int(paths / samples.size()), kLeastPaths, kMostPaths);
  std::vector<Vec3f> indirect =
      trace_illumination(tracer_, samples, {unity}, {each, settings_.bounces, settings_.seed, false}).value;
  const Column direct = response.direct(position);
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    for (int c = 0; c < 3; ++c) indirect[k][c] -= float(direct(Eigen::Index(receivers[k]), c));
  }
  return indirect;
}

}  // namespace chiaro::inverse
