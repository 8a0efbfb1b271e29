// Fast non-negative least squares, an active-set method on the normal equations.
// Sources: R. Bro, S. de Jong, A fast non-negativity-constrained least squares algorithm, J. Chemometrics 11, 1997;
// C. Lawson, R. Hanson, Solving Least Squares Problems, 1974, chapter 23 (the letters below are theirs).
//
// Notation, after every column of A is scaled to unit length and Aᵀb to a largest entry of 1:
//   x   the solution so far, ≥ 0            P   the passive set, where x is free to be > 0
//   w   Aᵀ(b − A x), the downhill gradient  L   Cholesky factor of (AᵀA) over P, in the order of P
// Every move is a Newton step from the present x with a fresh w, so that rounding does not build up in x.

#include "inverse/numerics/nnls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include "inverse/numerics/growing_cholesky.h"

namespace chiaro::inverse::numerics {
namespace {

// A column is linearly dependent on the passive ones when its squared distance from their span is ≤ kDependent.
constexpr double kDependent = 1e-12;
constexpr double kNegligibleShare = 1e-10;
constexpr double kMeasurableDescent = 1e-14;  // of the objective, relative
constexpr double kTolerableRise = 1e-9;       // of the objective, relative: rounding
constexpr double kSoundGradient = 1e-6;
constexpr double kSoundObjective = 1e-3;
constexpr int kMaxRefinements = 2;

struct Problem {
  const Eigen::MatrixXd& gram;
  const Eigen::VectorXd& scale;  // 1 / ‖a_j‖; 0: a zero column, never used
  Eigen::VectorXd atb;           // scaled
  double tolerance;
  int max_iterations;
};

struct State {
  Eigen::VectorXd x, w;
  std::vector<int> passive;
  std::vector<char> is_passive;
  GrowingCholesky factor;
  int iterations = 0;
};

Eigen::VectorXd inverse_column_norms(const Eigen::MatrixXd& gram) {
  return gram.diagonal().unaryExpr([](double square) { return square > 0 ? 1 / std::sqrt(square) : 0; });
}

void update_gradient(const Problem& problem, State& state) {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(state.x.size());
  for (const int k : state.passive) product += (problem.scale[k] * state.x[k]) * problem.gram.col(k);
  state.w = problem.atb - problem.scale.cwiseProduct(product);
}

// ½ ‖A x − b‖² − ½ ‖b‖².
double objective(const Problem& problem, const State& state) { return -0.5 * state.x.dot(problem.atb + state.w); }

Eigen::VectorXd at_passive(const Eigen::VectorXd& all, const State& state) {
  Eigen::VectorXd values(Eigen::Index(state.passive.size()));
  for (int i = 0; i < values.size(); ++i) values[i] = all[state.passive[i]];
  return values;
}

Eigen::VectorXd products_with_passive(const Problem& problem, const State& state, int j) {
  Eigen::VectorXd products(Eigen::Index(state.passive.size()));
  for (int i = 0; i < products.size(); ++i) {
    const int k = state.passive[i];
    products[i] = problem.gram(k, j) * problem.scale[k] * problem.scale[j];
  }
  return products;
}

void append(State& state, int j, const GrowingCholesky::Row& row) {
  state.factor.append(row);
  state.passive.push_back(j);
  state.is_passive[j] = 1;
}

void remove(State& state, int position) {
  const int k = state.passive[position];
  state.x[k] = 0;
  state.is_passive[k] = 0;
  state.factor.remove(position);
  state.passive.erase(state.passive.begin() + position);
}

// Moves x along `step` (over P) as far as x ≥ 0 allows, at most all the way, and takes what reaches 0 out of P.
// Returns whether it went all the way.
bool advance(State& state, const Eigen::VectorXd& step) {
  double length = 1;
  int limit = -1;
  for (int i = 0; i < step.size(); ++i) {
    const double x = state.x[state.passive[i]];
    if (x + length * step[i] < 0) limit = i, length = -x / step[i];
  }
  for (int i = 0; i < step.size(); ++i) state.x[state.passive[i]] += length * step[i];
  for (int i = int(step.size()) - 1; i >= 0; --i) {
    if (i == limit || !(state.x[state.passive[i]] > 0)) remove(state, i);
  }
  return limit < 0;
}

// Lawson & Hanson's inner loop (steps 6 to 11): the least-squares solution over P, or over the part of P where it is
// positive. Takes an x that is positive over P and its w, and leaves both so.
void solve_over_passive(const Problem& problem, State& state) {
  int complete_steps = 0;
  while (!state.passive.empty() && state.iterations < problem.max_iterations) {
    ++state.iterations;
    complete_steps += advance(state, state.factor.solve(at_passive(state.w, state))) ? 1 : 0;
    update_gradient(problem, state);
    if (complete_steps == 0) continue;
    const bool exact =
        state.passive.empty() || at_passive(state.w, state).cwiseAbs().maxCoeff() <= 0.1 * problem.tolerance;
    if (exact || complete_steps > kMaxRefinements) return;
  }
}

// Column j is Σ_i share_i a_i over P but for a rest of squared length `pivot`, so that x_j can grow at the expense of
// the others at next to no change of A x, until one of them is used up: that one leaves P.
// Returns false where the rest, which is not known to better than kDependent, would matter before.
bool exchange(const Problem& problem, State& state, int j, double pivot) {
  const Eigen::VectorXd share = state.factor.solve(products_with_passive(problem, state, j));
  int limit = -1;
  double growth = 0;
  for (int i = 0; i < share.size(); ++i) {
    if (!(share[i] > kNegligibleShare)) continue;
    const double ratio = state.x[state.passive[i]] / share[i];
    if (limit < 0 || ratio < growth) limit = i, growth = ratio;
  }
  if (limit < 0 || growth * std::max(kDependent, std::abs(pivot)) > state.w[j]) return false;
  for (int i = 0; i < share.size(); ++i) {
    double& x = state.x[state.passive[i]];
    x = std::max(0.0, x - growth * share[i]);
  }
  state.x[j] += growth;
  remove(state, limit);
  return true;
}

// Brings column j into P, in exchange for others as long as it depends on them.
void enter(const Problem& problem, State& state, int j) {
  bool moved = false;
  for (;;) {
    const GrowingCholesky::Row row = state.factor.make_row(products_with_passive(problem, state, j), 1);
    if (row.pivot > kDependent) {
      append(state, j, row);
      break;
    }
    if (!exchange(problem, state, j, row.pivot)) {
      state.x[j] = 0;
      break;
    }
    moved = true;
  }
  if (moved) update_gradient(problem, state);
}

// The column outside P along which the objective falls most steeply, if any does (steps 2 to 4).
std::optional<int> steepest_column(const Problem& problem, const State& state, const std::vector<char>& barred) {
  std::optional<int> best;
  double steepest = problem.tolerance;
  for (int j = 0; j < state.w.size(); ++j) {
    if (state.is_passive[j] || barred[j] || problem.scale[j] == 0) continue;
    if (state.w[j] > steepest) best = j, steepest = state.w[j];
  }
  return best;
}

// Whether double precision carries the solution over P: its gradient over P is as good as zero, and the rounding of AᵀA
// does not matter in the objective. Where this fails, columns of P cancel each other almost entirely.
bool sound(const Problem& problem, const State& state) {
  if (state.passive.empty()) return true;
  const double rounding = std::numeric_limits<double>::epsilon() * std::pow(state.x.sum(), 2);
  return at_passive(state.w, state).cwiseAbs().maxCoeff() <= kSoundGradient &&
         rounding <= kSoundObjective * std::abs(objective(problem, state));
}

State cold_state(const Problem& problem) {
  const Eigen::Index n = problem.atb.size();
  return {Eigen::VectorXd::Zero(n), problem.atb, {}, std::vector<char>(n, 0), {}, 0};
}

// P from the columns in `order` with x > 0, without those that depend on earlier ones.
State state_at(const Problem& problem, const Eigen::VectorXd& x, const std::vector<int>& order) {
  State state = cold_state(problem);
  for (const int j : order) {
    if (!(x[j] > 0) || !std::isfinite(x[j]) || problem.scale[j] == 0) continue;
    const GrowingCholesky::Row row = state.factor.make_row(products_with_passive(problem, state, j), 1);
    if (!(row.pivot > kDependent)) continue;
    append(state, j, row);
    state.x[j] = x[j];
  }
  update_gradient(problem, state);
  return state;
}

// From a feasible x, scaled; from 0 where that is not sound.
State start_from(const Problem& problem, const Eigen::VectorXd& x) {
  std::vector<int> order(x.size());
  std::iota(order.begin(), order.end(), 0);
  State state = state_at(problem, x, order);
  solve_over_passive(problem, state);
  return sound(problem, state) ? state : cold_state(problem);
}

// Lawson & Hanson's outer loop. Between two measurable descents of the objective every column may enter once, so that
// rounding cannot make it cycle; and an entry that does more harm than good is taken back.
void solve_from(const Problem& problem, State& state) {
  std::vector<char> barred(state.is_passive.size(), 0);
  double lowest = objective(problem, state);
  while (state.iterations < problem.max_iterations) {
    const std::optional<int> j = steepest_column(problem, state, barred);
    if (!j) return;
    barred[*j] = 1;
    ++state.iterations;
    const Eigen::VectorXd last_x = state.x, last_w = state.w;
    const std::vector<int> last_passive = state.passive;
    enter(problem, state, *j);
    solve_over_passive(problem, state);
    const double value = objective(problem, state);
    if (!sound(problem, state) || !(value <= lowest + kTolerableRise * std::abs(lowest))) {
      const int iterations = state.iterations;
      state = state_at(problem, last_x, last_passive);
      state.iterations = iterations;
      if (state.passive == last_passive) continue;
      state.x = last_x, state.w = last_w;
      return;  // the last solution is at the limit of precision already
    }
    if (value < lowest - kMeasurableDescent * std::abs(lowest)) {
      lowest = value;
      barred.assign(barred.size(), 0);
    }
  }
}

// The KKT conditions: w = 0 where x > 0, w ≤ 0 where x = 0.
double kkt_violation(const Problem& problem, const State& state) {
  double worst = 0;
  for (int j = 0; j < state.x.size(); ++j) {
    if (problem.scale[j] == 0) continue;
    worst = std::max(worst, state.x[j] > 0 ? std::abs(state.w[j]) : state.w[j]);
  }
  return worst;
}

void check_shapes(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& atb, const Eigen::MatrixXd* warm_start) {
  const bool fit = gram.rows() == gram.cols() && atb.rows() == gram.rows() &&
                   (!warm_start || (warm_start->rows() == atb.rows() && warm_start->cols() == atb.cols()));
  if (!fit) throw std::invalid_argument("nnls: the shapes of the matrices do not fit");
  if (!gram.allFinite() || !atb.allFinite()) throw std::invalid_argument("nnls: an entry is not finite");
}

}  // namespace

NnlsResult nnls(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& atb, const NnlsOptions& options,
                const Eigen::MatrixXd* warm_start) {
  check_shapes(gram, atb, warm_start);
  const int columns = int(gram.cols());
  const int max_iterations = options.max_iterations > 0 ? options.max_iterations : 10 * columns;
  const Eigen::VectorXd scale = inverse_column_norms(gram);
  NnlsResult result;
  result.x = Eigen::MatrixXd::Zero(atb.rows(), atb.cols());
  for (Eigen::Index side = 0; side < atb.cols(); ++side) {
    const Eigen::VectorXd scaled = scale.cwiseProduct(atb.col(side));
    const double unit = columns > 0 ? scaled.cwiseAbs().maxCoeff() : 0;
    if (!(unit > 0)) continue;
    const Problem problem{gram, scale, scaled / unit, options.kkt_tolerance, max_iterations};
    Eigen::VectorXd start = Eigen::VectorXd::Zero(columns);
    if (warm_start) start = warm_start->col(side).cwiseQuotient(scale) / unit;
    State state = start_from(problem, start);
    solve_from(problem, state);
    result.x.col(side) = unit * scale.cwiseProduct(state.x);
    result.kkt_residual = std::max(result.kkt_residual, kkt_violation(problem, state));
    result.iterations += state.iterations;
  }
  result.converged = result.kkt_residual <= options.kkt_tolerance;
  return result;
}

}  // namespace chiaro::inverse::numerics
