#include "inverse/solve/fit_traced_columns.h"

#include "inverse/numerics/decompositions.h"

namespace chiaro::inverse {
namespace {

constexpr double kRounding = 1e-10;  // of a column's square

// A′ᵀA, made symmetric. Where columns are hardly told apart noise may leave next to nothing of it, or less, and so much
// of AᵀA stays that intensities are bounded. Both with the columns scaled to unit length.
Eigen::MatrixXd gram_without_noise(const WeightedSystem& one, const WeightedSystem& other) {
  const Eigen::MatrixXd with_noise = (one.a.transpose() * one.a + other.a.transpose() * other.a) / 2;
  const Eigen::MatrixXd product = other.a.transpose() * one.a;
  const Eigen::VectorXd length = with_noise.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = length.unaryExpr([](double l) { return l > 0 ? 1 / l : 0; });
  Eigen::MatrixXd all = inverse.asDiagonal() * with_noise * inverse.asDiagonal();
  all.diagonal().array() += kRounding;
  const Eigen::MatrixXd sure = inverse.asDiagonal() * (product + product.transpose()) * inverse.asDiagonal() / 2;
  const numerics::Eigendecomposition eigen = numerics::generalized_eigen(sure, all);
  const Eigen::MatrixXd directions = length.asDiagonal() * all * eigen.vectors;
  return directions * eigen.values.cwiseMax(kLeastSure).asDiagonal() * directions.transpose();
}

}  // namespace

IntensityFit fit_traced_columns(const Observations& observations, const std::vector<Column>& columns,
                                const std::vector<Column>& again) {
  if (columns.empty()) return {};
  const std::array<WeightedSystem, 3> one = weighted_systems(observations, columns);
  const std::array<WeightedSystem, 3> other = weighted_systems(observations, again);
  std::array<NormalEquations, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c] = {gram_without_noise(one[c], other[c]), (one[c].a + other[c].a).transpose() * one[c].b / 2};
  }
  return fit_intensities(channels, observations.rules);
}

}  // namespace chiaro::inverse
