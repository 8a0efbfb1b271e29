#include "inverse/numerics/working_set_nnls.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

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
  EXPECT_NEAR(result.kkt_residual, kkt_violation(system, result.x), 1e-12);
}

// More columns than are taken at once.
System positive_system(int rows, int columns, unsigned seed) {
  System system = random_system(rows, columns, 3, seed);
  system.a = system.a.cwiseAbs();
  system.b = system.b.cwiseAbs();
  return system;
}

TEST(WorkingSetNnls, EqualsNnlsOfTheProducts) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const System system = positive_system(400, 100 + 150 * int(seed), seed);
    const NnlsResult result = working_set_nnls(system.a, system.b);
    expect_optimal(system, result);
    const double expected = squared_error(system, nnls(system.gram(), system.atb()).x);
    EXPECT_NEAR(squared_error(system, result.x), expected, 1e-12 * expected);
  }
}

TEST(WorkingSetNnls, MoreColumnsThanRows) {
  for (unsigned seed = 20; seed < 24; ++seed) {
    System system = positive_system(60, 900, seed);
    expect_optimal(system, working_set_nnls(system.a, system.b));
    system = random_system(60, 600, 2, seed);
    expect_optimal(system, working_set_nnls(system.a, system.b));
  }
}

TEST(WorkingSetNnls, ThousandsOfNearlyParallelColumns) {
  const System system = bumps(300, 3000, 0.05, 1);
  expect_optimal(system, working_set_nnls(system.a, system.b));
}

TEST(WorkingSetNnls, ColumnsOfWildlyDifferentScale) {
  System system = bumps(200, 800, 0.05, 2);
  const MatrixXd expected = working_set_nnls(system.a, system.b).x;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-8, 8);
  const VectorXd factors = VectorXd::NullaryExpr(800, [&] { return std::pow(10.0, exponent(random)); });
  System wild{system.a * factors.asDiagonal(), system.b};
  const NnlsResult result = working_set_nnls(wild.a, wild.b);
  expect_optimal(wild, result);
  const double error = squared_error(system, expected);
  EXPECT_NEAR(squared_error(wild, result.x), error, 1e-9 * error);
}

TEST(WorkingSetNnls, CopiesNearCopiesAndZeroColumns) {
  for (unsigned seed = 40; seed < 60; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-16, -1);
    System system = random_system(80, 500, 2, seed);
    for (int j = 100; j < 480; ++j) {
      system.a.col(j) =
          system.a.col(int(random() % 100)) + std::pow(10.0, exponent(random)) * random_matrix(80, 1, random);
    }
    system.a.rightCols(20) = system.a.leftCols(20);
    system.a.middleCols(470, 10).setZero();
    expect_optimal(system, working_set_nnls(system.a, system.b));
  }
}

TEST(WorkingSetNnls, RankDeficientAndExactlySolvable) {
  for (unsigned seed = 60; seed < 66; ++seed) {
    std::mt19937 random(seed);
    System system{random_matrix(200, 8, random).cwiseAbs() * random_matrix(8, 700, random).cwiseAbs(), {}};
    system.b = system.a * random_matrix(700, 2, random).cwiseMax(0);
    expect_optimal(system, working_set_nnls(system.a, system.b));
  }
}

TEST(WorkingSetNnls, EverySideIsSolvedByItself) {
  const System system = bumps(150, 600, 0.05, 4);
  const NnlsResult together = working_set_nnls(system.a, system.b);
  for (int side = 0; side < 3; ++side) {
    EXPECT_EQ(together.x.col(side), working_set_nnls(system.a, system.b.col(side)).x.col(0));
  }
}

TEST(WorkingSetNnls, WarmStartsReachTheSameObjectiveSooner) {
  const System system = bumps(200, 1000, 0.05, 5);
  const NnlsResult cold = working_set_nnls(system.a, system.b);
  const NnlsResult warm = working_set_nnls(system.a, system.b, {}, &cold.x);
  expect_optimal(system, warm);
  const double expected = squared_error(system, cold.x);
  EXPECT_NEAR(squared_error(system, warm.x), expected, 1e-9 * expected);
  EXPECT_LT(warm.iterations, cold.iterations / 2);
}

TEST(WorkingSetNnls, WarmStartsMayBeAnything) {
  const System system = bumps(150, 400, 0.05, 6);
  const double expected = squared_error(system, working_set_nnls(system.a, system.b).x);
  MatrixXd odd = MatrixXd::Constant(400, 3, -1);
  odd.topRows(100).setConstant(1e9);
  for (const MatrixXd& start : {MatrixXd(MatrixXd::Ones(400, 3)), odd}) {
    const NnlsResult warm = working_set_nnls(system.a, system.b, {}, &start);
    expect_optimal(system, warm);
    EXPECT_NEAR(squared_error(system, warm.x), expected, 1e-9 * expected);
  }
}

TEST(WorkingSetNnls, NothingHelpsWhereEveryColumnPointsAway) {
  const NnlsResult result = working_set_nnls(MatrixXd::Identity(300, 300), VectorXd::Constant(300, -1));
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.x.squaredNorm(), 0);
  EXPECT_EQ(working_set_nnls(MatrixXd::Identity(3, 3), VectorXd::Zero(3)).x.squaredNorm(), 0);
  EXPECT_EQ(working_set_nnls(MatrixXd(3, 0), MatrixXd::Ones(3, 2)).x.cols(), 2);
}

TEST(WorkingSetNnls, SaysWhenItRanOutOfIterations) {
  const System system = positive_system(200, 600, 7);
  const NnlsResult result = working_set_nnls(system.a, system.b, {.max_iterations = 3});
  EXPECT_FALSE(result.converged);
  EXPECT_GE(result.x.minCoeff(), 0.0);
}

TEST(WorkingSetNnls, RefusesShapesThatDoNotFitAndValuesThatAreNotFinite) {
  EXPECT_THROW(working_set_nnls(MatrixXd::Identity(3, 2), VectorXd::Ones(2)), std::invalid_argument);
  EXPECT_THROW(working_set_nnls(MatrixXd::Identity(2, 2), VectorXd::Constant(2, NAN)), std::invalid_argument);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
