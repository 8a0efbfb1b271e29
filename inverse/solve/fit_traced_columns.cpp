#include "inverse/solve/fit_traced_columns.h"

#include <Eigen/Eigenvalues>

namespace chiaro::inverse {
namespace {

// Noise may leave what should be none a little below it, where columns are hardly told apart.
Eigen::MatrixXd positive_part(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of(symmetric);
  return of.eigenvectors() * of.eigenvalues().cwiseMax(0).asDiagonal() * of.eigenvectors().transpose();
}

}  // namespace

IntensityFit fit_traced_columns(const Observations& observations, const std::vector<Column>& columns,
                                const std::vector<Column>& again) {
  if (columns.empty()) return {};
  const std::array<WeightedSystem, 3> one = weighted_systems(observations, columns);
  const std::array<WeightedSystem, 3> other = weighted_systems(observations, again);
  std::array<NormalEquations, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::MatrixXd product = other[c].a.transpose() * one[c].a;
    channels[c] = {positive_part((product + product.transpose()) / 2),
                   (one[c].a + other[c].a).transpose() * one[c].b / 2};
  }
  return fit_intensities(channels, observations.rules);
}

}  // namespace chiaro::inverse
