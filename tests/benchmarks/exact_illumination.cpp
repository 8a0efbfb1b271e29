#include "tests/benchmarks/exact_illumination.h"

#include <cmath>

#include "inverse/transport/gather_operator.h"

namespace chiaro::benchmarks {
namespace {

using renderer::PointLight;
using renderer::Vec3f;

constexpr std::size_t kJudged = 4000;  // receivers

}  // namespace

ExactIllumination::ExactIllumination(const Stage& stage)
    : tracer_(stage.tracer),
      samples_(
          inverse::select_receivers(stage.receivers, inverse::evenly_spread(stage.receivers.size(), kJudged)).samples),
      gather_(inverse::make_gather_operator(tracer_, samples_, {})) {}

double ExactIllumination::error(const std::vector<PointLight>& truth,
                                const std::vector<inverse::FoundLight>& found) const {
  std::vector<PointLight> lights;
  for (const inverse::FoundLight& light : found) lights.push_back(std::get<renderer::PointLight>(light.light));
  const std::vector<Vec3f> wanted = illumination(truth), got = illumination(lights);
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    difference += double(length_squared(got[i] - wanted[i]));
    norm += double(length_squared(wanted[i]));
  }
  return std::sqrt(difference / norm);
}

std::vector<Vec3f> ExactIllumination::illumination(const std::vector<PointLight>& lights) const {
  std::vector<Vec3f> sum(samples_.size()), positions;
  for (const PointLight& light : lights) positions.push_back(light.position);
  const auto indirect = inverse::indirect_illumination_by_light(tracer_, gather_, positions);
  for (std::size_t j = 0; j < lights.size(); ++j) {
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const bool lit = inverse::sees(tracer_, samples_[i], positions[j], std::uint32_t(i));
      const float direct = lit ? inverse::unoccluded_illumination(samples_[i], positions[j]) : 0;
      sum[i] += lights[j].intensity * (Vec3f{direct, direct, direct} + indirect[j][i]);
    }
  }
  return sum;
}

}  // namespace chiaro::benchmarks
