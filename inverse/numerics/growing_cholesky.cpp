#include "inverse/numerics/growing_cholesky.h"

#include <algorithm>
#include <cmath>

namespace chiaro::inverse::numerics {

GrowingCholesky::Row GrowingCholesky::make_row(const Eigen::VectorXd& column, double diagonal) const {
  Row row{column, 0};
  factor_.topLeftCorner(size_, size_).triangularView<Eigen::Lower>().solveInPlace(row.entries);
  row.pivot = diagonal - row.entries.squaredNorm();
  return row;
}

void GrowingCholesky::append(const Row& row) {
  if (size_ == factor_.rows()) {
    const Eigen::Index capacity = std::max<Eigen::Index>(16, 2 * factor_.rows());
    factor_.conservativeResize(capacity, capacity);
  }
  factor_.row(size_).head(size_) = row.entries.transpose();
  factor_(size_, size_) = std::sqrt(row.pivot);
  ++size_;
}

void GrowingCholesky::remove(int index) {
  for (int column = 0; column < size_; ++column) {
    double* entries = factor_.col(column).data();
    const int first = std::max(index, column - 1);
    std::copy(entries + first + 1, entries + size_, entries + first);
  }
  --size_;
  // The rows below the removed one now reach one entry past the diagonal: rotate that entry away, column by column.
  for (int column = index; column < size_; ++column) {
    const double a = factor_(column, column), b = factor_(column, column + 1);
    const double length = std::hypot(a, b), cosine = a / length, sine = b / length;
    for (int row = column; row < size_; ++row) {
      const double left = factor_(row, column), right = factor_(row, column + 1);
      factor_(row, column) = cosine * left + sine * right;
      factor_(row, column + 1) = cosine * right - sine * left;
    }
  }
}

Eigen::VectorXd GrowingCholesky::solve(const Eigen::VectorXd& b) const {
  const auto lower = factor_.topLeftCorner(size_, size_);
  Eigen::VectorXd x = b;
  lower.triangularView<Eigen::Lower>().solveInPlace(x);
  lower.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

}  // namespace chiaro::inverse::numerics
