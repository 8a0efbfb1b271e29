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

// Makes the light's indirect illumination indirect(receiver, channel), where it stands now.
template <class Indirect>
void set_correction(const LightResponse& response, LightEstimate& light, std::size_t receivers,
                    const Indirect& indirect) {
  light.correction = -response.interpolated_indirect(light.position);
  for (std::size_t i = 0; i < receivers; ++i) {
    for (int c = 0; c < 3; ++c) light.correction(Eigen::Index(i), c) += double(indirect(i, c));
  }
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

void ExactIndirect::correct(const LightResponse& response, LightEstimates& lights) const {
  const auto correct_some = [&](std::size_t first, std::size_t count, const auto& illumination) {
    std::vector<Vec3f> positions;
    for (std::size_t l = 0; l < count; ++l) positions.push_back(to_vec3f(lights[first + l].position));
    const auto exact = illumination(tracer_, gather_, positions);
    for (std::size_t l = 0; l < count; ++l) {
      set_correction(response, lights[first + l], exact.size(),
                     [&](std::size_t i, int c) { return exact[i].channel[c][l]; });
    }
  };
  for (std::size_t first = 0; first < lights.size(); first += kLightBlock) {
    const std::size_t count = std::min<std::size_t>(kLightBlock, lights.size() - first);
    if (count <= LightQuad::kLanes) {
      correct_some(first, count, indirect_illumination_of_few);
    } else {
      correct_some(first, count, indirect_illumination);
    }
  }
}

void ExactIndirect::correct_by_paths(const LightResponse& response, LightEstimates& lights) const {
  std::vector<std::size_t> all(response.receiver_count());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::size_t paths = kPathsPerSample * std::size_t(settings_.samples);
  for (LightEstimate& light : lights) {
    const std::vector<Vec3f> indirect = traced(response, all, light.position, paths / lights.size());
    set_correction(response, light, indirect.size(), [&](std::size_t i, int c) { return indirect[i][c]; });
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
