#include "inverse/solve/held_out.h"

#include <algorithm>
#include <cmath>

#include "inverse/solve/directly_lit.h"
#include "inverse/solve/refine_joint.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr int kPointsPerSample = 32, kPathsPerPoint = 16, kRaysPerPoint = 32;
constexpr double kLeastPart = 0.1;  // of the way, that lights are led, as light by bounces changes on it
constexpr JointRefinementOptions kDescent{.max_iterations = 15, .function_tolerance = 1e-4};
constexpr double kMissed = 0.3;     // of a receiver's brightness …
constexpr double kSignificant = 5;  // … and standard errors, that its residual is more than

// Absent: lights may not stand there.
std::optional<LightEstimates> part_of_the_way(const AllowedPlaces& places, const LightEstimates& from,
                                              const LightEstimates& to, double part) {
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t j = 0; j < from.size(); ++j) {
    positions.emplace_back(from[j].position + part * (to[j].position - from[j].position));
  }
  if (!places.settle(positions)) return std::nullopt;
  LightEstimates there = to;
  for (std::size_t j = 0; j < there.size(); ++j) there[j].position = positions[j];
  return there;
}

TransportCache cache_of_nothing(std::size_t receivers) {
  TransportCache cache;
  cache.receiver_count = receivers;
  return cache;
}

}  // namespace

HeldOut::HeldOut(const renderer::RayTracer& tracer, const std::vector<renderer::SurfaceSample>& receivers,
                 Observations observations, Observations judged, const BakeSettings& settings,
                 const renderer::Control& control)
    : tracer_(tracer),
      observations_(std::move(observations)),
      judged_(std::move(judged)),
      gather_(make_gather_operator(tracer, receivers,
                                   {.samples = settings.samples,
                                    .points_per_sample = kPointsPerSample,
                                    .paths_per_point = kPathsPerPoint,
                                    .rays_per_point = kRaysPerPoint,
                                    .bounces = settings.bounces,
                                    .seed = settings.seed},
                                   control.without_progress())),
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

void HeldOut::descend(const LightResponse& search, LightEstimates& lights,
                      const std::vector<const Column*>& indirect) const {
  const DirectlyLit directly_lit(tracer_, search, response_.receivers());
  for (std::size_t j = 0; j < lights.size(); ++j) lights[j].correction = *indirect[j];
  lead_lights(directly_lit.response(), judged_, kDescent, lights);
}

double HeldOut::error(const Eigen::VectorXd& residuals) const {
  const Eigen::ArrayXd weight = observations_.sqrt_weight.array();
  const Eigen::ArrayXd by_objective = (weight > 0).select(judged_.sqrt_weight.array() / weight, 0);
  return (by_objective * residuals.array()).matrix().norm() / judged_.target_norm;
}

double HeldOut::relative_l2(const Eigen::VectorXd& residuals) const {
  return residuals.norm() / observations_.target_norm;
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

bool HeldOutSets::lead_closer(const LightResponse& search, LightEstimates& lights, HeldOutFit& least) {
  LightEstimates led = lights;
  held_out_.descend(search, led, indirect(lights));
  for (double part = 1; part > kLeastPart; part /= 2) {
    auto there = part_of_the_way(search.places(), lights, led, part);
    if (!there) continue;
    const HeldOutFit fit = refit(*there);
    if (!(fit.error < least.error)) continue;
    lights = std::move(*there);
    least = fit;
    return true;
  }
  return false;
}

bool clearly_smaller(const Eigen::VectorXd& before, const Eigen::VectorXd& after, double standard_errors) {
  const Eigen::VectorXd gain = before - after;
  const double mean = gain.mean(), count = double(gain.size());
  return mean > standard_errors * std::sqrt((gain.array() - mean).square().sum()) / count;
}

}  // namespace chiaro::inverse
