#include "inverse/numerics/nnls.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include "tests/inverse/numerics/nnls_systems.h"

namespace chiaro::inverse::numerics {
namespace {

void expect_optimal(const System& system, const NnlsResult& result) {
  ASSERT_EQ(result.x.rows(), system.a.cols());
  ASSERT_EQ(result.x.cols(), system.b.cols());
  EXPECT_TRUE(result.x.allFinite());
  EXPECT_GE(result.x.minCoeff(), 0.0);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.kkt_residual, 1e-9);
  EXPECT_LE(kkt_violation(system, result.x), 2e-8);
}

// The best over all 2ⁿ passive sets.
double exhaustive_squared_error(const System& system) {
  const int columns = int(system.a.cols());
  double best = system.b.squaredNorm();
  for (int set = 1; set < 1 << columns; ++set) {
    std::vector<int> members;
    for (int j = 0; j < columns; ++j) {
      if (set >> j & 1) members.push_back(j);
    }
    const MatrixXd part = system.a(Eigen::all, members);
    const MatrixXd x = part.completeOrthogonalDecomposition().solve(system.b);
    if (x.minCoeff() >= 0) best = std::min(best, (part * x - system.b).squaredNorm());
  }
  return best;
}

TEST(Nnls, OfAnIdentityIsThePositivePart) {
  const MatrixXd gram = MatrixXd::Identity(3, 3), atb = Eigen::Vector3d(2, -1, 0.5);
  const NnlsResult result = nnls(gram, atb);
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(result.x.isApprox(Eigen::Vector3d(2, 0, 0.5), 1e-15));
}

TEST(Nnls, TwoColumnsInClosedForm) {
  // The free solution of these is (7/6, −1/3); with x ≥ 0 it is (1, 0).
  const MatrixXd gram = (MatrixXd(2, 2) << 1, 0.5, 0.5, 1).finished(), atb = Eigen::Vector2d(1, 0.25);
  const NnlsResult result = nnls(gram, atb);
  EXPECT_NEAR(result.x(0), 1, 1e-14);
  EXPECT_EQ(result.x(1), 0);
}

TEST(Nnls, WhereTheFreeSolutionIsPositiveItIsTheSolution) {
  System system = random_system(60, 20, 1, 3);
  const VectorXd wanted = VectorXd::LinSpaced(20, 0.1, 3);
  system.b = system.a * wanted;
  EXPECT_LE((nnls(system.gram(), system.atb()).x - wanted).norm(), 1e-10 * wanted.norm());
}

TEST(Nnls, NothingHelpsWhereEveryColumnPointsAway) {
  const NnlsResult result = nnls(MatrixXd::Identity(4, 4), VectorXd::Constant(4, -1));
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.x.squaredNorm(), 0);
}

TEST(Nnls, SatisfiesKktOnRandomSystems) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const System system = random_system(80, 10 + 5 * int(seed), 3, seed);
    expect_optimal(system, nnls(system.gram(), system.atb()));
  }
}

TEST(Nnls, EqualsTheBestOverAllPassiveSets) {
  for (unsigned seed = 100; seed < 160; ++seed) {
    System system = random_system(4 + int(seed % 6), 7, 1, seed);
    if (seed % 3 == 0) system.a.col(5) = system.a.col(1);
    if (seed % 4 == 0) system.a.col(2).setZero();
    const NnlsResult result = nnls(system.gram(), system.atb());
    expect_optimal(system, result);
    EXPECT_NEAR(squared_error(system, result.x), exhaustive_squared_error(system), 1e-9 * system.b.squaredNorm());
  }
}

TEST(Nnls, DuplicateAndZeroColumns) {
  System system = random_system(40, 24, 2, 5);
  for (int j = 0; j < 8; ++j) system.a.col(8 + j) = system.a.col(j);
  for (int j = 0; j < 4; ++j) system.a.col(16 + j).setZero();
  system.a.col(20) = 3 * system.a.col(0);
  const NnlsResult result = nnls(system.gram(), system.atb());
  expect_optimal(system, result);
  EXPECT_EQ(result.x.middleRows(16, 4).squaredNorm(), 0);
}

TEST(Nnls, RankDeficient) {
  for (unsigned seed = 200; seed < 230; ++seed) {
    std::mt19937 random(seed);
    System system{random_matrix(50, 6, random) * random_matrix(6, 40, random), {}};
    system.b = random_matrix(50, 3, random);
    expect_optimal(system, nnls(system.gram(), system.atb()));
  }
}

TEST(Nnls, PositiveAndRankDeficient) {
  for (unsigned seed = 230; seed < 250; ++seed) {
    std::mt19937 random(seed);
    const MatrixXd left = random_matrix(60, 5, random).cwiseAbs(), right = random_matrix(5, 50, random).cwiseAbs();
    System system{left * right, {}};
    system.b = system.a * random_matrix(50, 1, random).cwiseAbs() + 0.1 * random_matrix(60, 1, random);
    expect_optimal(system, nnls(system.gram(), system.atb()));
  }
}

TEST(Nnls, MoreColumnsThanRows) {
  for (unsigned seed = 300; seed < 310; ++seed) {
    System system = random_system(20, 120, 3, seed);
    expect_optimal(system, nnls(system.gram(), system.atb()));
    system.a = system.a.cwiseAbs();
    expect_optimal(system, nnls(system.gram(), system.atb()));
  }
}

TEST(Nnls, ColumnsOfWildlyDifferentScale) {
  for (unsigned seed = 400; seed < 420; ++seed) {
    System system = random_system(60, 40, 2, seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-4, 4);
    const System plain = system;
    const VectorXd factors = VectorXd::NullaryExpr(40, [&] { return std::pow(10.0, exponent(random)); });
    system.a = system.a * factors.asDiagonal();
    const NnlsResult result = nnls(system.gram(), system.atb());
    expect_optimal(system, result);
    const MatrixXd expected = nnls(plain.gram(), plain.atb()).x;
    EXPECT_LE((factors.asDiagonal() * result.x - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(Nnls, TheUnitOfTheRightHandSideDoesNotMatter) {
  const System system = random_system(30, 20, 1, 6);
  const MatrixXd x = nnls(system.gram(), system.atb()).x;
  for (const double unit : {1e-150, 1e-8, 1e8, 1e150}) {
    EXPECT_LE((nnls(system.gram(), unit * system.atb()).x / unit - x).norm(), 1e-12 * x.norm());
  }
}

TEST(Nnls, NearlyParallelColumns) {
  for (const int columns : {147, 500}) {
    const System system = bumps(300, columns, 0.05, unsigned(columns));
    expect_optimal(system, nnls(system.gram(), system.atb()));
  }
}

TEST(Nnls, ColumnsThatDifferByAMillionth) {
  System system = random_system(50, 30, 1, 7);
  std::mt19937 random(8);
  system.a.rightCols(15) = system.a.leftCols(15) + 1e-6 * random_matrix(50, 15, random);
  const NnlsResult result = nnls(system.gram(), system.atb());
  EXPECT_TRUE(result.x.allFinite());
  EXPECT_GE(result.x.minCoeff(), 0.0);
  EXPECT_LE(kkt_violation(system, result.x), 1e-6);
  System half = system;
  half.a = system.a.leftCols(15).eval();
  EXPECT_LE(squared_error(system, result.x), squared_error(half, nnls(half.gram(), half.atb()).x) * (1 + 1e-9));
}

// At every distance from a copy to a column of its own, through the range where double precision cannot tell.
TEST(Nnls, ColumnsAtEverySmallDistanceFromOthers) {
  for (unsigned seed = 600; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-16, -1);
    System system = random_system(35, 60, 2, seed);
    for (int j = 15; j < 60; ++j) {
      const int other = int(random() % unsigned(j));
      system.a.col(j) = system.a.col(other) + std::pow(10.0, exponent(random)) * random_matrix(35, 1, random);
    }
    expect_optimal(system, nnls(system.gram(), system.atb()));
  }
}

// What fits best here needs weights of a million and more that cancel each other: beyond the normal equations.
TEST(Nnls, ColumnsThatCancelEachOtherDoNotBreakIt) {
  for (unsigned seed = 500; seed < 560; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-14, -2);
    System system = random_system(25, 80, 1, seed);
    for (int j = 10; j < 80; ++j) {
      const double sign = random() % 2 ? 1 : -1;
      const int other = int(random() % unsigned(j));
      system.a.col(j) = sign * system.a.col(other) + std::pow(10.0, exponent(random)) * random_matrix(25, 1, random);
    }
    const NnlsResult result = nnls(system.gram(), system.atb());
    EXPECT_TRUE(result.x.allFinite());
    EXPECT_GE(result.x.minCoeff(), 0.0);
    EXPECT_LE(squared_error(system, result.x), system.b.squaredNorm());
    EXPECT_EQ(result.converged, result.kkt_residual <= 1e-9);
  }
}

TEST(Nnls, EveryRightHandSideIsSolvedByItself) {
  const System system = random_system(50, 60, 3, 9);
  const MatrixXd gram = system.gram(), atb = system.atb();
  const NnlsResult together = nnls(gram, atb);
  int iterations = 0;
  for (int side = 0; side < 3; ++side) {
    const NnlsResult alone = nnls(gram, atb.col(side));
    EXPECT_EQ(together.x.col(side), alone.x.col(0));
    iterations += alone.iterations;
  }
  EXPECT_EQ(together.iterations, iterations);
}

TEST(Nnls, WarmStartsReachTheSameObjective) {
  const System system = bumps(200, 100, 0.05, 10);
  const MatrixXd gram = system.gram(), atb = system.atb();
  const NnlsResult cold = nnls(gram, atb);
  const double expected = squared_error(system, cold.x);
  std::mt19937 random(11);
  const MatrixXd full = MatrixXd::Ones(100, 3), sparse = random_matrix(100, 3, random).cwiseMax(1.5).array() - 1.5;
  for (const MatrixXd& start : {cold.x, full, sparse, MatrixXd(1e6 * full)}) {
    const NnlsResult warm = nnls(gram, atb, {}, &start);
    expect_optimal(system, warm);
    EXPECT_NEAR(squared_error(system, warm.x), expected, 1e-9 * expected);
  }
  EXPECT_LT(nnls(gram, atb, {}, &cold.x).iterations, cold.iterations);
}

TEST(Nnls, SaysWhenItRanOutOfIterations) {
  const System system = random_system(80, 60, 1, 12);
  const NnlsResult result = nnls(system.gram(), system.atb(), {.max_iterations = 5});
  EXPECT_FALSE(result.converged);
  EXPECT_GT(result.kkt_residual, 1e-9);
  EXPECT_GE(result.x.minCoeff(), 0.0);
}

TEST(Nnls, SameBytesEveryTime) {
  const System system = bumps(200, 100, 0.05, 13);
  EXPECT_EQ(nnls(system.gram(), system.atb()).x, nnls(system.gram(), system.atb()).x);
}

TEST(Nnls, NoColumnsOrNoRightHandSides) {
  EXPECT_EQ(nnls(MatrixXd(0, 0), MatrixXd(0, 3)).x.cols(), 3);
  EXPECT_TRUE(nnls(MatrixXd(0, 0), MatrixXd(0, 3)).converged);
  EXPECT_EQ(nnls(MatrixXd::Identity(3, 3), MatrixXd(3, 0)).x.rows(), 3);
}

TEST(Nnls, RefusesShapesThatDoNotFitAndValuesThatAreNotFinite) {
  EXPECT_THROW(nnls(MatrixXd::Identity(3, 2), VectorXd::Ones(3)), std::invalid_argument);
  EXPECT_THROW(nnls(MatrixXd::Identity(3, 3), VectorXd::Ones(2)), std::invalid_argument);
  EXPECT_THROW(nnls(MatrixXd::Identity(2, 2), VectorXd::Constant(2, NAN)), std::invalid_argument);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
