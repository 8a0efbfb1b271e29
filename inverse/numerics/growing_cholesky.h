#pragma once

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

// Cholesky factor L of a symmetric positive definite matrix L Lᵀ that gains and loses rows: O(p²) each instead of the
// O(p³) of a new factorisation. The order of the rows is that of appending.
// Source: Golub & Van Loan, Matrix Computations, 4th ed. 2013, section 6.5.
class GrowingCholesky {
 public:
  struct Row {
    Eigen::VectorXd entries;  // of L, left of the diagonal
    double pivot = 0;         // squared diagonal entry of L: squared distance from the span of the other columns
  };

  int size() const { return size_; }

  // The row that a further column would have, without adding it. `column`: its products with the present ones.
  Row make_row(const Eigen::VectorXd& column, double diagonal) const;

  // row.pivot > 0.
  void append(const Row& row);

  void remove(int index);

  // (L Lᵀ)⁻¹ b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  Eigen::MatrixXd factor_;  // the lower triangle of the first size_ rows and columns; the rest has no meaning
  int size_ = 0;
};

}  // namespace chiaro::inverse::numerics
