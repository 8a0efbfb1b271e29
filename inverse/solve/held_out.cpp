#include "inverse/solve/held_out.h"

#include <algorithm>
#include <cmath>

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr int kPointsPerSample = 32, kPathsPerPoint = 16, kRaysPerPoint = 32;
constexpr double kMissed = 0.3;     // of a receiver's brightness …
constexpr double kSignificant = 5;  // … and standard errors, that its residual is more than

TransportCache cache_of_nothing(std::size_t receivers) {
  TransportCache cache;
  cache.receiver_count = receivers;
  return cache;
}

}  // namespace

HeldOut::HeldOut(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                 Observations observations, Observations judged, const BakeSettings& settings)
    : tracer_(tracer),
      observations_(std::move(observations)),
      judged_(std::move(judged)),
      gather_(make_gather_operator(tracer, receivers,
                                   {.samples = settings.samples,
                                    .points_per_sample = kPointsPerSample,
                                    .paths_per_point = kPathsPerPoint,
                                    .rays_per_point = kRaysPerPoint,
                                    .bounces = settings.bounces,
                                    .seed = settings.seed})),
      nothing_(cache_of_nothing(receivers.size())),
      response_(tracer, receivers, nothing_) {}

std::vector<Column> HeldOut::indirect(const LightEstimates& lights) const {
  std::vector<Column> columns;
  for (const auto& light : indirect_illumination_by_light(tracer_, gather_, light_positions(lights))) {
    columns.push_back(column_of(light));
  }
  return columns;
}

HeldOutFit HeldOut::refit(LightEstimates& lights, const std::vector<const Column*>& indirect) const {
  std::vector<Column> columns;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    columns.push_back(response_.direct(lights[j].position) + *indirect[j]);
  }
  const double error = refit_intensities(judged_, columns, lights);
  return {error, relative_error(observations_, total_illumination(columns, lights, observations_.wanted.rows()))};
}

double HeldOut::error(const Eigen::VectorXd& residuals) const {
  const Eigen::ArrayXd weight = observations_.sqrt_weight.array();
  const Eigen::ArrayXd by_objective = (weight > 0).select(judged_.sqrt_weight.array() / weight, 0);
  return (by_objective * residuals.array()).matrix().norm() / judged_.target_norm;
}

Eigen::VectorXd HeldOut::residuals(const LightEstimates& lights, const std::vector<const Column*>& indirect) const {
  Column left = -observations_.wanted;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    left += (response_.direct(lights[j].position) + *indirect[j]) * lights[j].intensity.matrix().asDiagonal();
  }
  return (observations_.sqrt_weight.asDiagonal() * left).rowwise().norm();
}

double HeldOut::part_missed(const Eigen::VectorXd& residuals) const {
  const Eigen::VectorXd brightness = observations_.sqrt_weight.cwiseProduct(observations_.target.rowwise().norm());
  const Eigen::VectorXd noise = observations_.sqrt_weight.cwiseProduct(observations_.standard_error);
  double missed = 0;
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    if (residuals[i] > std::max(kMissed * brightness[i], kSignificant * noise[i])) missed += brightness[i];
  }
  return missed > 0 ? missed / brightness.sum() : 0;
}

std::vector<const Column*> HeldOutSets::indirect(const LightEstimates& lights) {
  LightEstimates unknown;
  for (const LightEstimate& light : lights) {
    if (indirect_.find(light.position) == nullptr) unknown.push_back(light);
  }
  std::vector<Column> columns = held_out_.indirect(unknown);
  for (std::size_t j = 0; j < unknown.size(); ++j) indirect_.add(unknown[j].position, std::move(columns[j]));
  std::vector<const Column*> indirect;
  for (const LightEstimate& light : lights) indirect.push_back(&indirect_.find(light.position)->value);
  return indirect;
}

Eigen::VectorXd HeldOutSets::residuals(const LightEstimates& lights) {
  return held_out_.residuals(lights, indirect(lights));
}

HeldOutFit HeldOutSets::refit(LightEstimates& lights) { return held_out_.refit(lights, indirect(lights)); }

bool clearly_smaller(const Eigen::VectorXd& before, const Eigen::VectorXd& after, double standard_errors) {
  const Eigen::VectorXd gain = before - after;
  const double mean = gain.mean(), count = double(gain.size());
  return mean > standard_errors * std::sqrt((gain.array() - mean).square().sum()) / count;
}

}  // namespace chiaro::inverse
