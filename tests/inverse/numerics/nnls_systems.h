#pragma once
// Systems for tests of non-negative least squares, and what their solutions must satisfy.

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct System {
  MatrixXd a, b;
  MatrixXd gram() const { return a.transpose() * a; }
  MatrixXd atb() const { return a.transpose() * b; }
};

inline MatrixXd random_matrix(int rows, int columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

inline System random_system(int rows, int columns, int sides, unsigned seed) {
  std::mt19937 random(seed);
  System system{random_matrix(rows, columns, random), {}};
  system.b = random_matrix(rows, sides, random);
  return system;
}

// Bumps on a line, as lights on a grid are: positive, broad, nearly parallel. b is a positive mixture of a few off-grid
// bumps, and noise.
inline System bumps(int rows, int columns, double width, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto bump = [&](double row, double centre) {
    const double d = (row / rows - centre) / width;
    return 1 / (1 + d * d);
  };
  System system{MatrixXd(rows, columns), MatrixXd::Zero(rows, 3)};
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) system.a(i, j) = bump(i, (j + 0.5) / columns);
  }
  for (int i = 0; i < rows; ++i) {
    for (int light = 0; light < 6; ++light) {
      for (int side = 0; side < 3; ++side) system.b(i, side) += (1 + light % (side + 2)) * bump(i, 0.137 * light + 0.1);
    }
  }
  for (double& value : system.b.reshaped()) value += 0.01 * normal(random);
  return system;
}

// The KKT conditions from A and b themselves, every column scaled to unit length.
inline double kkt_violation(const System& system, const MatrixXd& x) {
  const MatrixXd gradient = system.a.transpose() * (system.b - system.a * x);
  double worst = 0;
  for (Eigen::Index side = 0; side < x.cols(); ++side) {
    double unit = 0, violation = 0;
    for (Eigen::Index j = 0; j < x.rows(); ++j) {
      const double length = system.a.col(j).norm();
      if (length == 0) continue;
      unit = std::max(unit, std::abs(system.a.col(j).dot(system.b.col(side))) / length);
      const double w = gradient(j, side) / length;
      violation = std::max(violation, x(j, side) > 0 ? std::abs(w) : w);
    }
    if (unit > 0) worst = std::max(worst, violation / unit);
  }
  return worst;
}

inline double squared_error(const System& system, const MatrixXd& x) { return (system.a * x - system.b).squaredNorm(); }

}  // namespace chiaro::inverse::numerics
