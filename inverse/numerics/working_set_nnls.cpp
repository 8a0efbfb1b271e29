// Notation: S the working set; w = Aᵀ(b − A x), columns of A at unit length, over the largest |Aᵀb|; x is 0 outside S.

#include "inverse/numerics/working_set_nnls.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace chiaro::inverse::numerics {
namespace {

constexpr Eigen::Index kFew = 256;        // columns: all of them at once
constexpr std::size_t kLeastGrowth = 64;  // columns a round
constexpr double kInnerTolerance = 0.1;   // of the tolerance: leaves room for the rounding of AᵀA

struct Problem {
  const Eigen::MatrixXd& a;
  const Eigen::VectorXd& inverse_length;  // of columns; 0: a zero column, never used
  Eigen::VectorXd b;
  double unit;  // the largest |Aᵀb|, columns at unit length
};

struct WorkingSet {
  std::vector<int> columns;
  std::vector<char> has;
  Eigen::MatrixXd a, gram;
  Eigen::VectorXd atb, x;
};

void insert(const Problem& problem, WorkingSet& set, const std::vector<int>& columns) {
  const auto before = Eigen::Index(set.columns.size()), more = Eigen::Index(columns.size()), after = before + more;
  set.a.conservativeResize(problem.a.rows(), after);
  set.a.rightCols(more) = problem.a(Eigen::all, columns);
  set.gram.conservativeResize(after, after);
  set.gram.rightCols(more).noalias() = set.a.transpose() * set.a.rightCols(more);
  set.gram.bottomLeftCorner(more, before) = set.gram.topRightCorner(before, more).transpose();
  set.atb.conservativeResize(after);
  set.atb.tail(more) = set.a.rightCols(more).transpose() * problem.b;
  set.x.conservativeResizeLike(Eigen::VectorXd::Zero(after));
  for (const int j : columns) set.columns.push_back(j), set.has[std::size_t(j)] = 1;
}

Eigen::VectorXd gradient(const Problem& problem, const WorkingSet& set) {
  const Eigen::VectorXd residual = problem.b - set.a * set.x;
  return problem.inverse_length.cwiseProduct(problem.a.transpose() * residual) / problem.unit;
}

// Outside S; the steepest first, at most as many as S has with x > 0, but for the first few.
std::vector<int> violating_columns(const WorkingSet& set, const Eigen::VectorXd& w, double tolerance) {
  std::vector<int> violating;
  for (int j = 0; j < w.size(); ++j) {
    if (!set.has[std::size_t(j)] && w[j] > tolerance) violating.push_back(j);
  }
  const auto positive = std::size_t((set.x.array() > 0).count());
  const std::size_t most = std::min(violating.size(), std::max(kLeastGrowth, positive));
  std::partial_sort(violating.begin(), violating.begin() + std::ptrdiff_t(most), violating.end(),
                    [&](int i, int j) { return w[i] != w[j] ? w[i] > w[j] : i < j; });
  violating.resize(most);
  return violating;
}

std::vector<int> first_columns(const Problem& problem, const Eigen::VectorXd& start) {
  std::vector<int> columns;
  for (int j = 0; j < start.size(); ++j) {
    if (problem.inverse_length[j] > 0 && (start.size() <= kFew || start[j] > 0)) columns.push_back(j);
  }
  return columns;
}

double kkt_violation(const WorkingSet& set, const Eigen::VectorXd& w) {
  double worst = std::max(0.0, w.maxCoeff());
  for (std::size_t i = 0; i < set.columns.size(); ++i) {
    if (set.x[Eigen::Index(i)] > 0) worst = std::max(worst, -w[set.columns[i]]);
  }
  return worst;
}

void solve_over(WorkingSet& set, const NnlsOptions& options, NnlsResult& result) {
  NnlsOptions inner = options;
  inner.kkt_tolerance *= kInnerTolerance;
  const Eigen::MatrixXd start = set.x;
  const NnlsResult over_set = nnls(set.gram, set.atb, inner, &start);
  set.x = over_set.x;
  result.iterations += over_set.iterations;
}

void solve_side(const Problem& problem, Eigen::Index side, const NnlsOptions& options, NnlsResult& result) {
  const Eigen::VectorXd start = result.x.col(side);
  WorkingSet set;
  set.has.assign(std::size_t(start.size()), 0);
  insert(problem, set, first_columns(problem, start));
  for (std::size_t i = 0; i < set.columns.size(); ++i) set.x[Eigen::Index(i)] = start[set.columns[i]];
  Eigen::VectorXd w;
  for (std::vector<int> more;; insert(problem, set, more)) {
    solve_over(set, options, result);
    w = gradient(problem, set);
    more = violating_columns(set, w, options.kkt_tolerance);
    if (more.empty()) break;
  }
  result.x.col(side).setZero();
  for (std::size_t i = 0; i < set.columns.size(); ++i) result.x(set.columns[i], side) = set.x[Eigen::Index(i)];
  result.kkt_residual = std::max(result.kkt_residual, kkt_violation(set, w));
}

void check_shapes(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd* warm_start) {
  const bool fit =
      a.rows() == b.rows() && (!warm_start || (warm_start->rows() == a.cols() && warm_start->cols() == b.cols()));
  if (!fit) throw std::invalid_argument("nnls: the shapes of the matrices do not fit");
  if (!a.allFinite() || !b.allFinite()) throw std::invalid_argument("nnls: an entry is not finite");
}

}  // namespace

NnlsResult working_set_nnls(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const NnlsOptions& options,
                            const Eigen::MatrixXd* warm_start) {
  check_shapes(a, b, warm_start);
  const Eigen::VectorXd inverse_length =
      a.colwise().norm().transpose().unaryExpr([](double length) { return length > 0 ? 1 / length : 0; });
  NnlsResult result;
  result.x = warm_start ? *warm_start : Eigen::MatrixXd::Zero(a.cols(), b.cols());
  for (Eigen::Index side = 0; side < b.cols(); ++side) {
    const Eigen::VectorXd scaled = inverse_length.cwiseProduct(a.transpose() * b.col(side));
    const double unit = scaled.size() > 0 ? scaled.cwiseAbs().maxCoeff() : 0;
    if (unit > 0) {
      solve_side({a, inverse_length, b.col(side), unit}, side, options, result);
    } else {
      result.x.col(side).setZero();
    }
  }
  result.converged = result.kkt_residual <= options.kkt_tolerance;
  return result;
}

}  // namespace chiaro::inverse::numerics
