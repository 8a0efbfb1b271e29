#include "inverse/solve/observe_target.h"

#include <cmath>

#include "inverse/solve/pooled_errors.h"

namespace chiaro::inverse {

ReceiverDraw draw_evenly(const Target& target, std::size_t most) {
  std::vector<std::size_t> weighted;
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    if (target.weight[i] > 0) weighted.push_back(i);
  }
  ReceiverDraw draw;
  const std::size_t count = std::min(most, weighted.size());
  for (std::size_t k = 0; k < count; ++k) draw.chosen.push_back(weighted[k * weighted.size() / count]);
  draw.probability.assign(count, double(count) / double(std::max<std::size_t>(weighted.size(), 1)));
  return draw;
}

Observations observe_target(const Target& target, const ReceiverDraw& draw, const std::vector<Vec3f>& fixed) {
  const auto count = Eigen::Index(draw.chosen.size());
  Observations o;
  o.target.resize(count, 3);
  o.wanted.resize(count, 3);
  o.sqrt_weight.resize(count);
  o.stands_for.resize(count);
  o.standard_error = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t receiver = draw.chosen[std::size_t(i)];
    for (int c = 0; c < 3; ++c) {
      o.target(i, c) = double(target.illumination[receiver][c]);
      o.wanted(i, c) = o.target(i, c) - double(fixed[std::size_t(i)][c]);
    }
    o.sqrt_weight[i] = std::sqrt(double(target.weight[receiver]));
    o.stands_for[i] = 1 / draw.probability[std::size_t(i)];
  }
  o.measure_target();
  return o;
}

Observations with_noise(Observations observations, const Target& target, const std::vector<std::size_t>& chosen) {
  const std::vector<float> standard_error = pooled_standard_errors(target, chosen);
  for (std::size_t i = 0; i < standard_error.size(); ++i) {
    observations.standard_error[Eigen::Index(i)] = double(standard_error[i]);
  }
  observations.measure_target();
  return observations;
}

double target_noise(const Target& target) {
  if (target.standard_error.empty()) return 0;
  double error = 0, value = 0;
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    error += 3 * double(target.weight[i]) * double(target.standard_error[i]) * double(target.standard_error[i]);
    value += double(target.weight[i]) * double(length_squared(target.illumination[i]));
  }
  return value > 0 ? std::sqrt(error / value) : 0;
}

}  // namespace chiaro::inverse
