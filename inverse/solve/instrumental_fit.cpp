#include "inverse/solve/instrumental_fit.h"

#include <algorithm>
#include <numeric>

#include "inverse/numerics/decompositions.h"
#include "inverse/numerics/median.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr int kSteps = 12;
constexpr double kStepAtRest = 3e-5;   // of the region's diagonal
constexpr double kLongestStep = 0.01;  // of the region's diagonal
constexpr double kFaster = 1.5;        // a light that goes on its way, after it turned
constexpr double kOutlier = 3;         // medians
constexpr double kFirefly = 10;        // medians
constexpr double kBeyondNoise = 60;    // standard errors
constexpr double kLeastScale = 1e-3;   // of a receiver's brightness
constexpr double kDark = 0.1;          // brightness that residuals are compared with at least, in means of all
constexpr double kDamping = 1e-9;      // of the normal matrix' diagonal
constexpr double kDarkest = 1e-20;     // candela: a channel that shines

Column residual_of(const Observations& observations, const std::vector<ColumnWithGradient>& direct,
                   const std::vector<Column>& indirect, const LightEstimates& lights) {
  Column residual = -observations.wanted;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    residual += (direct[j].value + indirect[j]) * lights[j].intensity.matrix().asDiagonal();
  }
  return residual;
}

// Of receivers whose residuals are beyond so many medians little is left. Dark ones, of which a scene may have any
// number, and which no light explains better or worse, have no part in the median.
Eigen::VectorXd robust_sqrt_weight(const Observations& observations, const Column& residual, double outlier) {
  const Eigen::ArrayXd brightness = observations.target.rowwise().norm();
  const double dark = kDark * brightness.mean();
  const Eigen::ArrayXd relative = residual.rowwise().norm().array() / brightness.max(dark);
  std::vector<double> lit;
  for (Eigen::Index i = 0; i < relative.size(); ++i) {
    if (brightness[i] > dark) lit.push_back(relative[i]);
  }
  const double scale = std::max(kLeastScale, outlier * numerics::median(std::move(lit)));
  return observations.sqrt_weight.array() / (1 + (relative / scale).square());
}

// The weights, squared, that intensities are fitted with. Noise is not symmetric: its fireflies are part of its mean,
// and without them light would be too dark. Where noise is known little is left of what it cannot be, such as strokes
// that no light makes; where it is not, of what is far beyond most.
Eigen::VectorXd weight_of_intensities(const Observations& observations, const Column& residual) {
  if (!(observations.noise > 0)) return robust_sqrt_weight(observations, residual, kFirefly).cwiseAbs2();
  const Eigen::ArrayXd in_noise = observations.sqrt_weight.array() * residual.rowwise().norm().array();
  return (observations.sqrt_weight.array() / (1 + (in_noise / kBeyondNoise).square())).square();
}

// How direct light, which is grey, changes with each light's x, y, z, then with its intensity; weighted.
Eigen::MatrixXd instruments_of(const std::vector<ColumnWithGradient>& direct, const Eigen::VectorXd& sqrt_weight) {
  const auto n = Eigen::Index(direct.size());
  Eigen::MatrixXd instruments(sqrt_weight.size(), 4 * n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const ColumnWithGradient& column = direct[std::size_t(j)];
    for (int a = 0; a < 3; ++a) instruments.col(3 * j + a) = sqrt_weight.cwiseProduct(column.gradient[a].col(0));
    instruments.col(3 * n + j) = sqrt_weight.cwiseProduct(column.value.col(0));
  }
  return instruments;
}

// What one channel says of its unknowns: x, y, z of each light, then the channel's intensity of each.
struct ChannelSystem {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;
};

ChannelSystem channel_system(const Eigen::MatrixXd& instruments, const Eigen::MatrixXd& gram,
                             const std::vector<Column>& indirect, const LightEstimates& lights, const Column& residual,
                             const Eigen::VectorXd& sqrt_weight, int channel) {
  const auto n = Eigen::Index(lights.size());
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(4 * n);
  Eigen::MatrixXd by_bounces(residual.rows(), n);
  for (Eigen::Index j = 0; j < n; ++j) {
    scale.segment<3>(3 * j).setConstant(lights[std::size_t(j)].intensity[channel]);
    by_bounces.col(j) = sqrt_weight.cwiseProduct(indirect[std::size_t(j)].col(channel));
  }
  ChannelSystem system;
  system.normal = scale.asDiagonal() * gram * scale.asDiagonal();
  system.normal.rightCols(n) += scale.asDiagonal() * (instruments.transpose() * by_bounces);
  const Eigen::VectorXd weighted = sqrt_weight.cwiseProduct(residual.col(channel));
  system.gradient = scale.asDiagonal() * (instruments.transpose() * weighted);
  return system;
}

// Unknowns: x, y, z of each light, then red, green, blue of each.
Eigen::VectorXd gauss_newton_step(const std::vector<ColumnWithGradient>& direct, const std::vector<Column>& indirect,
                                  const LightEstimates& lights, const Column& residual,
                                  const Eigen::VectorXd& sqrt_weight) {
  const auto n = Eigen::Index(lights.size());
  const Eigen::MatrixXd instruments = instruments_of(direct, sqrt_weight);
  const Eigen::MatrixXd gram = instruments.transpose() * instruments;
  std::array<ChannelSystem, 3> systems;
  renderer::parallel_for(3, [&](std::size_t c) {
    systems[c] = channel_system(instruments, gram, indirect, lights, residual, sqrt_weight, int(c));
  });
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(6 * n);
  std::vector<Eigen::Index> unknown(std::size_t(4 * n));
  std::iota(unknown.begin(), unknown.end(), Eigen::Index{0});
  for (Eigen::Index c = 0; c < 3; ++c) {
    for (Eigen::Index j = 0; j < n; ++j) unknown[std::size_t(3 * n + j)] = 3 * n + 3 * j + c;
    normal(unknown, unknown) += systems[std::size_t(c)].normal;
    gradient(unknown) += systems[std::size_t(c)].gradient;
  }
  normal.diagonal() *= 1 + kDamping;
  // A light that has no effect has no row.
  for (Eigen::Index k = 0; k < 6 * n; ++k) normal(k, k) += normal(k, k) > 0 ? 0 : 1;
  return -numerics::solve(normal, gradient);
}

// Steps of lights one after the other.
class Stepper {
 public:
  Stepper(const LightResponse& response, std::size_t lights)
      : response_(response), diagonal_(double(response.grid().region.diagonal())), pace_(lights) {}

  // As far as the step goes, within the region and the longest step; true: it moved.
  bool take(const Eigen::VectorXd& step, LightEstimates& lights) {
    double longest = 0;
    for (std::size_t j = 0; j < lights.size(); ++j) {
      const Eigen::Vector3d move = step.segment<3>(Eigen::Index(3 * j));
      slow_down_where_it_turns(move, pace_[j]);
      longest = std::max(longest, pace_[j].part * move.norm());
    }
    const double shorter = std::min(1.0, kLongestStep * diagonal_ / std::max(longest, 1e-300));
    for (std::size_t j = 0; j < lights.size(); ++j) {
      LightEstimate& light = lights[j];
      const double part = shorter * pace_[j].part;
      const Eigen::Vector3d moved = light.position + part * step.segment<3>(Eigen::Index(3 * j));
      light.position = response_.places().nearest(moved).value_or(light.position);
      const auto change = step.segment<3>(Eigen::Index(3 * (lights.size() + j)));
      light.intensity = (light.intensity + part * change.array()).max(0);
    }
    return longest > kStepAtRest * diagonal_;
  }

 private:
  struct Pace {
    double part = 1;  // of the step
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
  };

  // A light that steps over a shadow's edge is led back by what it sees beyond, and so on.
  static void slow_down_where_it_turns(const Eigen::Vector3d& move, Pace& pace) {
    pace.part = move.dot(pace.last) < 0 ? pace.part / 2 : std::min(1.0, kFaster * pace.part);
    pace.last = move;
  }

  const LightResponse& response_;
  double diagonal_;
  std::vector<Pace> pace_;
};

// Intensities of one channel, none negative: those that would be are held at zero.
Eigen::VectorXd solve_with_instruments(const Eigen::MatrixXd& normal, const Eigen::VectorXd& wanted) {
  std::vector<Eigen::Index> lit;
  for (Eigen::Index j = 0; j < normal.rows(); ++j) {
    if (normal(j, j) > 0) lit.push_back(j);
  }
  Eigen::VectorXd intensity = Eigen::VectorXd::Zero(normal.rows());
  while (!lit.empty()) {
    const Eigen::VectorXd solution = numerics::solve(normal(lit, lit), wanted(lit));
    if (solution.allFinite() && solution.minCoeff() >= 0) {
      intensity(lit) = solution;
      break;
    }
    Eigen::Index darkest = 0;
    if (solution.allFinite()) solution.minCoeff(&darkest);
    lit.erase(lit.begin() + darkest);
  }
  return intensity;
}

}  // namespace

Column unity_indirect(const Column& traced, const Column& direct, const Eigen::Array3d& intensity) {
  const auto shines = (intensity > kDarkest).eval();
  const Eigen::Array3d per_candela = shines.select(intensity.inverse(), 0);
  return traced * per_candela.matrix().asDiagonal() - direct * shines.cast<double>().matrix().asDiagonal();
}

void descend_with_instruments(const LightResponse& response, const Observations& observations,
                              const std::vector<Column>& indirect, LightEstimates& lights,
                              const std::function<bool()>& stop) {
  Stepper stepper(response, lights.size());
  for (int k = 0; k < kSteps && !(stop && stop()); ++k) {
    const std::vector<ColumnWithGradient> direct = evaluate_columns_with_gradient(response, lights);
    const Column residual = residual_of(observations, direct, indirect, lights);
    const Eigen::VectorXd weight = robust_sqrt_weight(observations, residual, kOutlier);
    const Eigen::VectorXd step = gauss_newton_step(direct, indirect, lights, residual, weight);
    if (!step.allFinite() || !stepper.take(step, lights)) return;
  }
}

void fit_intensities_with_instruments(const LightResponse& response, const Observations& observations,
                                      const std::vector<Column>& indirect, LightEstimates& lights) {
  const std::vector<Column> direct = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
  std::vector<Column> all = direct;
  for (std::size_t j = 0; j < lights.size(); ++j) all[j] += indirect[j];
  const Eigen::Index receivers = observations.wanted.rows(), n = Eigen::Index(lights.size());
  const Column left = total_illumination(all, lights, receivers) - observations.wanted;
  const Eigen::VectorXd weight = weight_of_intensities(observations, left);
  for (int c = 0; c < 3; ++c) {
    Eigen::MatrixXd normal(n, n);
    Eigen::VectorXd wanted(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::VectorXd instrument = weight.cwiseProduct(direct[std::size_t(j)].col(c));
      for (Eigen::Index k = 0; k < n; ++k) normal(j, k) = instrument.dot(all[std::size_t(k)].col(c));
      wanted[j] = instrument.dot(observations.wanted.col(c));
    }
    const Eigen::VectorXd intensity = solve_with_instruments(normal, wanted);
    for (Eigen::Index j = 0; j < n; ++j) lights[std::size_t(j)].intensity[c] = intensity[j];
  }
}

LightIntervals intervals_with_instruments(const LightResponse& response, const Observations& observations,
                                          const std::vector<Column>& indirect, const LightEstimates& lights) {
  if (lights.empty()) return {};
  std::vector<ColumnWithGradient> columns = evaluate_columns_with_gradient(response, lights);
  const Column residual = residual_of(observations, columns, indirect, lights);
  const Derivatives instruments = derivatives_of(columns, lights);
  for (std::size_t j = 0; j < lights.size(); ++j) columns[j].value += indirect[j];
  const Eigen::VectorXd weight = weight_of_intensities(observations, residual);
  return light_intervals({derivatives_of(columns, lights), instruments, residual, weight}, lights);
}

}  // namespace chiaro::inverse
