#include "inverse/solve/observe_target.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "inverse/solve/pooled_errors.h"
#include "inverse/transport/receivers.h"

namespace chiaro::inverse {

namespace {

constexpr std::size_t kEnoughLit = 200;  // receivers, of those drawn evenly

std::vector<std::size_t> of_positive_weight(const Target& target) {
  std::vector<std::size_t> weighted;
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    if (target.weight[i] > 0) weighted.push_back(i);
  }
  return weighted;
}

struct Drawn {
  std::size_t receiver;
  double probability;
};

std::vector<Drawn> evenly_of(const std::vector<std::size_t>& receivers, std::size_t most) {
  std::vector<Drawn> drawn;
  for (const std::size_t k : evenly_spread(receivers.size(), most)) drawn.push_back({receivers[k], 1});
  for (Drawn& one : drawn) one.probability = double(drawn.size()) / double(receivers.size());
  return drawn;
}

ReceiverDraw in_order(std::vector<Drawn> drawn) {
  std::sort(drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) { return a.receiver < b.receiver; });
  ReceiverDraw draw;
  for (const Drawn& one : drawn) {
    draw.chosen.push_back(one.receiver);
    draw.probability.push_back(one.probability);
  }
  return draw;
}

}  // namespace

ReceiverDraw draw_evenly(const Target& target, std::size_t most) {
  return in_order(evenly_of(of_positive_weight(target), most));
}

ReceiverDraw draw_brightest_and_evenly(const Target& target, const Eigen::VectorXd& brightness, std::size_t most) {
  std::vector<std::size_t> receivers = of_positive_weight(target);
  if (receivers.size() <= most) return draw_evenly(target, most);
  const auto bright = receivers.begin() + std::ptrdiff_t(most / 2);
  std::nth_element(receivers.begin(), bright, receivers.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(-brightness[Eigen::Index(a)], a) < std::pair(-brightness[Eigen::Index(b)], b);
  });
  std::vector<std::size_t> rest(bright, receivers.end());
  std::sort(rest.begin(), rest.end());
  std::vector<Drawn> drawn = evenly_of(rest, most - most / 2);
  std::for_each(receivers.begin(), bright, [&](std::size_t receiver) { drawn.push_back({receiver, 1}); });
  return in_order(std::move(drawn));
}

ReceiverDraw draw_with_the_lit(const Target& target, std::size_t most) {
  ReceiverDraw evenly = draw_evenly(target, most);
  const auto is_lit = [&](std::size_t i) { return max_component(target.illumination[i]) > 0; };
  const auto lit = std::count_if(evenly.chosen.begin(), evenly.chosen.end(), is_lit);
  if (std::size_t(lit) >= kEnoughLit || evenly.chosen.size() < most) return evenly;
  Eigen::VectorXd brightness(Eigen::Index(target.receivers.size()));
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    brightness[Eigen::Index(i)] = std::sqrt(squared_norm(target.illumination[i]));
  }
  return draw_brightest_and_evenly(target, brightness, most);
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
    value += double(target.weight[i]) * squared_norm(target.illumination[i]);
  }
  return value > 0 ? std::sqrt(error / value) : 0;
}

}  // namespace chiaro::inverse
