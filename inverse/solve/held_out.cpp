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
  const auto indirect = indirect_illumination_by_light(tracer_, gather_, light_positions(lights));
  Column left = -observations_.wanted;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const Column unity = response_.direct(lights[j].position) + column_of(indirect[j]);
    left += unity * lights[j].intensity.matrix().asDiagonal();
  }
  return (observations_.sqrt_weight.asDiagonal() * left).rowwise().norm();
}

bool clearly_smaller(const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  const Eigen::VectorXd gain = before - after;
  const double mean = gain.mean(), count = double(gain.size());
  return mean > kSignificant * std::sqrt((gain.array() - mean).square().sum()) / count;
}

}  // namespace chiaro::inverse
