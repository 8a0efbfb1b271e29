#include "inverse/numerics/decompositions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace {

using namespace chiaro::inverse::numerics;

constexpr double kTolerance = 1e-13;

// [2 1; 1 2] has 1 and 3, along [1 −1] and [1 1].
TEST(Decompositions, SymmetricMatrixHasItsEigenvaluesInAscendingOrder) {
  const Eigen::MatrixXd matrix{{2, 1}, {1, 2}};
  const Eigendecomposition eigen = symmetric_eigen(matrix);
  EXPECT_NEAR(eigen.values[0], 1, kTolerance);
  EXPECT_NEAR(eigen.values[1], 3, kTolerance);
  EXPECT_NEAR(eigen.vectors.col(0).sum(), 0, kTolerance);
  EXPECT_NEAR(std::abs(eigen.vectors.col(1).sum()), std::sqrt(2.0), kTolerance);
}

TEST(Decompositions, GeneralizedEigenvectorsAreOfUnitLengthInTheMetric) {
  const Eigen::MatrixXd matrix{{6, 1}, {1, 4}}, metric{{2, 0.5}, {0.5, 1}};
  const Eigendecomposition eigen = generalized_eigen(matrix, metric);
  EXPECT_LT(eigen.values[0], eigen.values[1]);
  EXPECT_LT((matrix * eigen.vectors - metric * eigen.vectors * eigen.values.asDiagonal()).norm(), kTolerance * 10);
  EXPECT_LT((eigen.vectors.transpose() * metric * eigen.vectors - Eigen::MatrixXd::Identity(2, 2)).norm(),
            kTolerance * 10);
}

TEST(Decompositions, BasisIsAsLargeAsTheSpaceThatColumnsSpan) {
  const Eigen::MatrixXd columns{{1, 2, 1}, {0, 0, 1}, {1, 2, 0}, {2, 4, 3}};  // the second is twice the first
  const Eigen::MatrixXd basis = orthonormal_basis(columns);
  ASSERT_EQ(basis.cols(), 2);
  EXPECT_LT((basis.transpose() * basis - Eigen::MatrixXd::Identity(2, 2)).norm(), kTolerance);
  EXPECT_LT((basis * (basis.transpose() * columns) - columns).norm(), kTolerance * 10);
}

TEST(Decompositions, InverseAndSolutionUndoTheMatrix) {
  const Eigen::MatrixXd matrix{{0, 2, 1}, {1, 0, 3}, {2, 1, 0}};  // elimination without pivoting would divide by 0
  const Eigen::VectorXd x{{1, -2, 3}};
  EXPECT_LT((inverted(matrix) * matrix - Eigen::MatrixXd::Identity(3, 3)).norm(), kTolerance);
  EXPECT_LT((solve(matrix, matrix * x) - x).norm(), kTolerance);
}

// Moore and Penrose's four conditions.
TEST(Decompositions, PseudoinverseOfASingularMatrixIsMooreAndPenroses) {
  const Eigen::MatrixXd a{{1, 2}, {2, 4}, {3, 6}};
  const Eigen::MatrixXd b = pseudoinverse(a);
  EXPECT_LT((a * b * a - a).norm(), kTolerance * 10);
  EXPECT_LT((b * a * b - b).norm(), kTolerance);
  EXPECT_LT((a * b - (a * b).transpose()).norm(), kTolerance);
  EXPECT_LT((b * a - (b * a).transpose()).norm(), kTolerance);
}

}  // namespace
