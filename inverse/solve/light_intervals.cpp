#include "inverse/solve/light_intervals.h"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "inverse/numerics/decompositions.h"
#include "inverse/solve/sandwich_estimate.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr int kParameters = 6;          // of a light: x, y, z, red, green, blue
constexpr double kMoreSure = 0.45;      // of a standard deviation, or less, is that of the sum
constexpr double kDarkChannel = 0.01;   // of the light's brightest
constexpr double kLeastOutside = 0.01;  // of what a receiver leaves, as far as the others decide it

// Receivers × parameters, by what one channel shows of them.
Eigen::MatrixXd jacobian(const std::vector<ColumnWithGradient>& columns, const LightEstimates& lights, int channel) {
  const auto n = Eigen::Index(lights.size());
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(columns[0].value.rows(), kParameters * n);
  for (Eigen::Index l = 0; l < n; ++l) {
    const ColumnWithGradient& column = columns[std::size_t(l)];
    for (int a = 0; a < 3; ++a) {
      j.col(kParameters * l + a) = lights[std::size_t(l)].intensity[channel] * column.gradient[a].col(channel);
    }
    j.col(kParameters * l + 3 + channel) = column.value.col(channel);
  }
  return j;
}

// Instruments × derivatives, weighted; for least squares, the normal matrix.
Eigen::MatrixXd product_of(const Derivatives& instruments, const Derivatives& derivatives,
                           const Eigen::VectorXd& weight) {
  std::array<Eigen::MatrixXd, 3> products;
  renderer::parallel_for(
      3, [&](std::size_t c) { products[c] = instruments[c].transpose() * weight.asDiagonal() * derivatives[c]; });
  return products[0] + products[1] + products[2];
}

// Pseudoinverse of instruments × derivatives, where the instruments tell something.
Eigen::MatrixXd inverse_of(const FitAtRest& fit, const Eigen::MatrixXd& basis) {
  if (basis.cols() == 0) return Eigen::MatrixXd::Zero(basis.rows(), basis.rows());
  const Eigen::MatrixXd product = product_of(fit.instruments, fit.derivatives, fit.weight);
  return basis * numerics::inverted(basis.transpose() * product * basis) * basis.transpose();
}

// What receivers `first` … would leave if each of them were left out of the fit.
Column left_out(const FitAtRest& fit, const Eigen::MatrixXd& inverse, Eigen::Index first, Eigen::Index count) {
  std::array<std::array<Eigen::VectorXd, 3>, 3> leverage;  // of each receiver, channels × channels
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::MatrixXd by = fit.derivatives[c].middleRows(first, count) * inverse;
    for (std::size_t d = 0; d < 3; ++d) {
      leverage[c][d] = by.cwiseProduct(fit.instruments[d].middleRows(first, count)).rowwise().sum();
    }
  }
  Column left(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Matrix3d own;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) own(Eigen::Index(c), Eigen::Index(d)) = leverage[c][d][i];
    }
    own *= fit.weight[first + i];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen((own + own.transpose()) / 2);
    const Eigen::Vector3d outside = (1 - eigen.eigenvalues().array()).max(kLeastOutside).inverse();
    left.row(i) =
        fit.residual.row(first + i) * eigen.eigenvectors() * outside.asDiagonal() * eigen.eigenvectors().transpose();
  }
  return left;
}

// How far each receiver moves each parameter, with what it would leave if it were left out of the fit.
Eigen::MatrixXd pulls_of(const FitAtRest& fit, const Eigen::MatrixXd& inverse) {
  constexpr Eigen::Index kBlock = 256;
  Eigen::MatrixXd pulls(fit.weight.size(), inverse.cols());
  renderer::parallel_for(std::size_t((pulls.rows() + kBlock - 1) / kBlock), [&](std::size_t block) {
    const Eigen::Index first = Eigen::Index(block) * kBlock, count = std::min(kBlock, pulls.rows() - first);
    const Column left = left_out(fit, inverse, first, count);
    Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(count, inverse.cols());
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd weighted = fit.weight.segment(first, count).cwiseProduct(left.col(c));
      pull += weighted.asDiagonal() * fit.instruments[std::size_t(c)].middleRows(first, count);
    }
    pulls.middleRows(first, count) = pull * inverse.transpose();
  });
  return pulls;
}

}  // namespace

bool may_shine(const Eigen::Array3d& intensity, int channel) {
  return intensity[channel] >= kDarkChannel * intensity.maxCoeff();
}

bool only_their_sum_is_known(double variance, double other_variance, double covariance, double dimmer) {
  if (std::isinf(variance) || std::isinf(other_variance)) return false;
  const double less = std::sqrt(std::min(variance, other_variance));
  const double of_sum = std::sqrt(std::max(0.0, variance + other_variance + 2 * covariance));
  return of_sum < kMoreSure * less && kNinety * less > dimmer;
}

void find_confounded(const IntensityErrors& errors, const std::vector<Eigen::Array3d>& intensity, int channel,
                     std::set<std::pair<std::size_t, std::size_t>>& pairs) {
  std::vector<std::size_t> shining;
  std::vector<Eigen::Index> parameters;
  for (std::size_t l = 0; l < intensity.size(); ++l) {
    if (!may_shine(intensity[l], channel)) continue;
    shining.push_back(l);
    parameters.push_back(errors.first + errors.step * Eigen::Index(l));
  }
  for (const auto& [j, k] : pairs_known_by_sum(errors.directions, parameters)) pairs.emplace(shining[j], shining[k]);
  for (std::size_t j = 0; j < shining.size(); ++j) {
    for (std::size_t k = j + 1; k < shining.size(); ++k) {
      const Eigen::Index a = parameters[j], b = parameters[k];
      const double dimmer = std::min(intensity[shining[j]][channel], intensity[shining[k]][channel]);
      if (only_their_sum_is_known(errors.covariance(a, a), errors.covariance(b, b), errors.covariance(a, b), dimmer)) {
        pairs.emplace(shining[j], shining[k]);
      }
    }
  }
}

LightIntervals unknown_intervals(std::size_t lights) {
  const double infinity = std::numeric_limits<double>::infinity();
  return {std::vector<LightInterval>(lights, {Eigen::Vector3d::Constant(infinity), Eigen::Array3d::Constant(infinity)}),
          {}};
}

Derivatives derivatives_of(const std::vector<ColumnWithGradient>& columns, const LightEstimates& lights) {
  return {jacobian(columns, lights, 0), jacobian(columns, lights, 1), jacobian(columns, lights, 2)};
}

LightIntervals light_intervals(const FitAtRest& fit, const LightEstimates& lights) {
  const KnownDirections directions = known_directions(product_of(fit.instruments, fit.instruments, fit.weight));
  const SandwichEstimate errors = sandwich_estimate(pulls_of(fit, inverse_of(fit, directions.basis)), directions);
  LightIntervals intervals;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    LightInterval& interval = intervals.lights.emplace_back();
    for (int a = 0; a < 3; ++a) {
      interval.position[a] = errors.half_width(Eigen::Index(kParameters * l) + a);
      interval.intensity[a] = errors.half_width(Eigen::Index(kParameters * l) + 3 + a);
    }
  }
  std::vector<Eigen::Array3d> intensity;
  for (const LightEstimate& light : lights) intensity.push_back(light.intensity);
  std::set<std::pair<std::size_t, std::size_t>> confounded;
  for (int c = 0; c < 3; ++c)
    find_confounded({directions, errors.covariance, 3 + c, kParameters}, intensity, c, confounded);
  intervals.confounded.assign(confounded.begin(), confounded.end());
  return intervals;
}

LightIntervals light_intervals(const LightResponse& response, const Observations& observations,
                               const LightEstimates& lights) {
  if (lights.empty()) return {};
  if (lights.size() > kMostLightsWithIntervals) return unknown_intervals(lights.size());
  const std::vector<ColumnWithGradient> columns = evaluate_columns_with_gradient(response, lights);
  const Derivatives derivatives = derivatives_of(columns, lights);
  Column residual = -observations.wanted;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    residual += columns[l].value * lights[l].intensity.matrix().asDiagonal();
  }
  return light_intervals({derivatives, derivatives, residual, observations.sqrt_weight.cwiseAbs2()}, lights);
}

}  // namespace chiaro::inverse
