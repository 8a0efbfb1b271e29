#include "inverse/numerics/bounded_least_squares.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct System {
  MatrixXd a;
  VectorXd b, upper;

  BoundedLeastSquares solve() const { return bounded_least_squares(a.transpose() * a, a.transpose() * b, upper); }
};

System random_system(unsigned seed, int rows, int columns) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-3, 3), limit(0, 1);
  System s{MatrixXd(rows, columns), VectorXd(rows), VectorXd(columns)};
  for (int j = 0; j < columns; ++j) {
    const double scale = std::pow(10, exponent(random));
    for (int i = 0; i < rows; ++i) s.a(i, j) = scale * std::abs(normal(random));
    s.upper[j] = limit(random) / scale;
  }
  for (int i = 0; i < rows; ++i) s.b[i] = 3 * normal(random) + 2;
  return s;
}

// No step along any axis, up or down, that stays within the bounds makes the fit better.
void expect_minimum(const System& s, const VectorXd& x) {
  const double cost = (s.a * x - s.b).squaredNorm();
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    for (const double part : {-1e-3, 1e-3}) {
      VectorXd other = x;
      other[j] = std::clamp(x[j] + part * std::min(s.upper[j], 1.0), 0.0, s.upper[j]);
      EXPECT_GE((s.a * other - s.b).squaredNorm(), cost * (1 - 1e-12)) << j;
    }
  }
}

TEST(BoundedLeastSquares, NoStepWithinTheBoundsIsBetter) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const System s = random_system(seed, 30, 1 + int(seed % 12));
    const BoundedLeastSquares result = s.solve();
    EXPECT_LE(result.kkt_residual, 1e-9) << seed;
    for (Eigen::Index j = 0; j < result.x.size(); ++j) {
      EXPECT_GE(result.x[j], 0);
      EXPECT_LE(result.x[j], s.upper[j]);
    }
    expect_minimum(s, result.x);
  }
}

TEST(BoundedLeastSquares, WithoutBoundsItIsNonNegativeLeastSquares) {
  System s{MatrixXd(3, 2), VectorXd(3), VectorXd::Constant(2, std::numeric_limits<double>::infinity())};
  s.a << 1, 0, 0, 1, 0, 0;
  s.b << 2, -1, 5;
  const BoundedLeastSquares result = s.solve();
  EXPECT_NEAR(result.x[0], 2, 1e-9);
  EXPECT_EQ(result.x[1], 0);
}

TEST(BoundedLeastSquares, ParallelAndEmptyColumnsAreFine) {
  System s = random_system(7, 20, 5);
  s.a.col(1) = 2 * s.a.col(0);
  s.a.col(3).setZero();
  const BoundedLeastSquares result = s.solve();
  EXPECT_TRUE(result.x.allFinite());
  EXPECT_EQ(result.x[3], 0);
  expect_minimum(s, result.x);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
