#include "inverse/solve/light_intervals.h"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace chiaro::inverse {
namespace {

constexpr int kParameters = 6;          // of a light: x, y, z, red, green, blue
constexpr double kNinety = 1.645;       // standard deviations to either side
constexpr double kOpposed = 0.9;        // correlation, and less than its negative: one makes good what the other lacks
constexpr double kUnknown = 1e-10;      // eigenvalue, of a matrix of unit diagonal: nothing is known in that direction
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

// The pseudoinverse of a normal matrix.
struct NormalInverse {
  Eigen::MatrixXd matrix;
  std::vector<bool> known;  // the normal matrix tells of this parameter
};

NormalInverse invert(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().unaryExpr([](double d) { return d > 0 ? 1 / d : 0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * normal * scale.asDiagonal());
  const Eigen::VectorXd inverse = eigen.eigenvalues().unaryExpr([](double e) { return e > kUnknown ? 1 / e : 0; });
  const Eigen::MatrixXd vectors = scale.asDiagonal() * eigen.eigenvectors();
  NormalInverse result{vectors * inverse.asDiagonal() * vectors.transpose(), {}};
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    double known = scale[k] > 0 ? 1 : 0;
    for (Eigen::Index e = 0; e < inverse.size(); ++e) {
      if (inverse[e] <= 0) known -= eigen.eigenvectors()(k, e) * eigen.eigenvectors()(k, e);
    }
    result.known.push_back(known >= 0.5);
  }
  return result;
}

// Receivers × parameters: how far each pulls, with what it would leave if it were left out of the fit.
Eigen::MatrixXd pulls_of(const std::array<Eigen::MatrixXd, 3>& jacobians, const Eigen::MatrixXd& residual,
                         const Eigen::VectorXd& weight, const Eigen::MatrixXd& inverse_normal) {
  Eigen::MatrixXd pull(weight.size(), inverse_normal.cols());
  Eigen::Matrix<double, 3, Eigen::Dynamic> j(3, inverse_normal.cols());
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    for (int c = 0; c < 3; ++c) j.row(c) = jacobians[std::size_t(c)].row(i);
    const Eigen::Matrix3d leverage = weight[i] * j * inverse_normal * j.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(leverage);
    const Eigen::Vector3d outside = (1 - eigen.eigenvalues().array()).max(kLeastOutside).inverse();
    const Eigen::Vector3d left_out =
        eigen.eigenvectors() * outside.asDiagonal() * eigen.eigenvectors().transpose() * residual.row(i).transpose();
    pull.row(i) = weight[i] * left_out.transpose() * j;
  }
  return pull;
}

// What one light has more the other has less, by as much as they shine.
bool only_the_sum_is_known(const Eigen::MatrixXd& covariance, const LightEstimates& lights, std::size_t j,
                           std::size_t k) {
  for (int c = 0; c < 3; ++c) {
    const auto a = Eigen::Index(kParameters * j + 3) + c, b = Eigen::Index(kParameters * k + 3) + c;
    const double one = std::sqrt(covariance(a, a)), other = std::sqrt(covariance(b, b));
    if (std::isinf(one) && std::isinf(other)) return true;
    const bool opposed = covariance(a, b) < -kOpposed * one * other;
    const double dimmer = std::min(lights[j].intensity[c], lights[k].intensity[c]);
    if (opposed && kNinety * std::min(one, other) > dimmer) return true;
  }
  return false;
}

}  // namespace

LightIntervals light_intervals(const LightResponse& response, const Observations& observations,
                               const LightEstimates& lights) {
  if (lights.empty()) return {};
  const std::vector<ColumnWithGradient> columns = evaluate_columns_with_gradient(response, lights);
  const auto parameters = Eigen::Index(kParameters * lights.size());
  const Eigen::VectorXd weight = observations.sqrt_weight.cwiseAbs2();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(parameters, parameters), residual = -observations.wanted;
  std::array<Eigen::MatrixXd, 3> jacobians;
  for (int c = 0; c < 3; ++c) {
    jacobians[std::size_t(c)] = jacobian(columns, lights, c);
    for (std::size_t l = 0; l < lights.size(); ++l) residual.col(c) += lights[l].intensity[c] * columns[l].value.col(c);
    normal += jacobians[std::size_t(c)].transpose() * weight.asDiagonal() * jacobians[std::size_t(c)];
  }
  const NormalInverse inverse = invert(normal);
  const Eigen::MatrixXd pull = pulls_of(jacobians, residual, weight, inverse.matrix);
  Eigen::MatrixXd covariance = inverse.matrix * (pull.transpose() * pull) * inverse.matrix;
  for (Eigen::Index k = 0; k < parameters; ++k) {
    if (!inverse.known[std::size_t(k)]) covariance(k, k) = std::numeric_limits<double>::infinity();
  }
  LightIntervals intervals;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Eigen::VectorXd half =
        kNinety * covariance.diagonal().segment<kParameters>(Eigen::Index(kParameters * l)).cwiseSqrt();
    intervals.lights.push_back({half.head<3>(), half.tail<3>()});
  }
  for (std::size_t j = 0; j < lights.size(); ++j) {
    for (std::size_t k = j + 1; k < lights.size(); ++k) {
      if (only_the_sum_is_known(covariance, lights, j, k)) intervals.confounded.emplace_back(j, k);
    }
  }
  return intervals;
}

}  // namespace chiaro::inverse
