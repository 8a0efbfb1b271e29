#pragma once
// Eigen's dense decompositions of matrices whose size is not known beforehand, compiled once: each takes a compiler ten
// seconds wherever it is included.

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

struct Eigendecomposition {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // n × n, one in each column
};

// Of a symmetric matrix, whose lower triangle is read; orthonormal vectors.
Eigendecomposition symmetric_eigen(const Eigen::MatrixXd& matrix);

// vectors v and values λ with matrix v = λ metric v, where both are symmetric and metric is positive definite; vᵀ
// metric v = 1.
Eigendecomposition generalized_eigen(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& metric);

// Of the space that the columns of an n × k matrix span, in n × (its rank), which rounding tells. n ≥ k.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns);

// Of a square matrix, by elimination with partial pivoting; not finite where there is none.
Eigen::MatrixXd inverted(const Eigen::MatrixXd& matrix);
Eigen::VectorXd solve(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

// Moore and Penrose's, of a matrix of any rank.
Eigen::MatrixXd pseudoinverse(const Eigen::MatrixXd& matrix);

}  // namespace chiaro::inverse::numerics
