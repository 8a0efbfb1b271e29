#include "inverse/solve/held_out.h"

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr double kSignificant = 3;  // standard errors
constexpr int kPointsPerSample = 32;

TransportCache cache_of_nothing(std::size_t receivers) {
  TransportCache cache;
  cache.receiver_count = receivers;
  return cache;
}

}  // namespace

HeldOut::HeldOut(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                 Observations observations, const BakeSettings& settings)
    : tracer_(tracer),
      observations_(std::move(observations)),
      gather_(make_gather_operator(tracer, receivers,
                                   {.samples = settings.samples,
                                    .points_per_sample = kPointsPerSample,
                                    .bounces = settings.bounces,
                                    .seed = settings.seed})),
      nothing_(cache_of_nothing(receivers.size())),
      response_(tracer, receivers, nothing_) {}

Eigen::VectorXd HeldOut::residuals(const LightEstimates& lights) const {
  Column left = -observations_.wanted;
  for (std::size_t first = 0; first < lights.size(); first += kLightBlock) {
    const std::size_t count = std::min<std::size_t>(kLightBlock, lights.size() - first);
    std::vector<Vec3f> positions;
    for (std::size_t l = 0; l < count; ++l) positions.push_back(to_vec3f(lights[first + l].position));
    const std::vector<LightBlock> indirect = indirect_illumination(tracer_, gather_, positions);
    for (std::size_t l = 0; l < count; ++l) {
      const LightEstimate& light = lights[first + l];
      Column unity = response_.direct(light.position);
      for (std::size_t i = 0; i < indirect.size(); ++i) {
        for (int c = 0; c < 3; ++c) unity(Eigen::Index(i), c) += double(indirect[i].channel[c][l]);
      }
      left += unity * light.intensity.matrix().asDiagonal();
    }
  }
  return (observations_.sqrt_weight.asDiagonal() * left).rowwise().norm();
}

bool clearly_smaller(const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  const Eigen::VectorXd gain = before - after;
  const double mean = gain.mean(), count = double(gain.size());
  return mean > kSignificant * std::sqrt((gain.array() - mean).square().sum()) / count;
}

}  // namespace chiaro::inverse
