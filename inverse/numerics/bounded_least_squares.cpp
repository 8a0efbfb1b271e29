#include "inverse/numerics/bounded_least_squares.h"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTolerance = 1e-10;  // of the gradient, relative to the largest of Aᵀb
constexpr double kRidge = 1e-13;      // of a unit diagonal: nearly parallel columns keep a solution

enum class State : std::uint8_t { kLower, kUpper, kFree };

// Columns scaled to unit length: x = scaled / length.
class ActiveSet {
 public:
  ActiveSet(const MatrixXd& gram, const VectorXd& atb, const VectorXd& upper)
      : length_(gram.diagonal().cwiseMax(0).cwiseSqrt()),
        inverse_(length_.unaryExpr([](double l) { return l > 0 ? 1 / l : 0; })),
        gram_(inverse_.asDiagonal() * gram * inverse_.asDiagonal()),
        atb_(inverse_.cwiseProduct(atb)),
        upper_(upper.cwiseProduct(length_)),
        x_(VectorXd::Zero(atb.size())),
        state_(std::size_t(atb.size()), State::kLower),
        tolerance_(kTolerance * std::max(atb_.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min())) {
    gram_.diagonal().array() += kRidge;
  }

  BoundedLeastSquares solve() {
    const int most = 10 * int(x_.size()) + 10;
    Index stuck = -1;
    while (iterations_ < most) {
      const Index next = most_violated(stuck);
      if (next < 0) break;
      ++iterations_;
      state(next) = State::kFree;
      descend();
      stuck = state(next) == State::kFree ? -1 : next;
    }
    return {inverse_.cwiseProduct(x_), violation(), iterations_};
  }

 private:
  State& state(Index j) { return state_[std::size_t(j)]; }
  State state(Index j) const { return state_[std::size_t(j)]; }
  VectorXd pull() const { return atb_ - gram_ * x_; }

  // By how much the cost falls with a step off the bound.
  double violation_at(Index j, double pull) const {
    if (inverse_[j] <= 0 || upper_[j] <= 0) return 0;
    return state(j) == State::kLower ? pull : state(j) == State::kUpper ? -pull : std::abs(pull);
  }

  // -1: none.
  Index most_violated(Index except) const {
    const VectorXd w = pull();
    Index worst = -1;
    double most = tolerance_;
    for (Index j = 0; j < x_.size(); ++j) {
      if (j == except || state(j) == State::kFree) continue;
      if (const double v = violation_at(j, w[j]); v > most) most = v, worst = j;
    }
    return worst;
  }

  double violation() const {
    const VectorXd w = pull();
    double most = 0;
    for (Index j = 0; j < x_.size(); ++j) most = std::max(most, violation_at(j, w[j]));
    return most / std::max(atb_.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  }

  // To the minimum over the free ones; those that meet a bound on the way stay there.
  void descend() {
    std::vector<Index> free;
    do {
      free.clear();
      for (Index j = 0; j < x_.size(); ++j) {
        if (state(j) == State::kFree) free.push_back(j);
      }
    } while (!free.empty() && !step(free));
  }

  // True: none met a bound.
  bool step(const std::vector<Index>& free) {
    const VectorXd direction = MatrixXd(gram_(free, free)).ldlt().solve(VectorXd(pull()(free)));
    double part = 1;
    Index met = -1;
    for (Index k = 0; k < direction.size(); ++k) {
      const Index j = free[std::size_t(k)];
      const double bound = direction[k] < 0 ? 0 : upper_[j];
      if (direction[k] == 0 || !std::isfinite(bound)) continue;
      if (const double reach = (bound - x_[j]) / direction[k]; reach < part) part = std::max(reach, 0.0), met = k;
    }
    for (Index k = 0; k < direction.size(); ++k) x_[free[std::size_t(k)]] += part * direction[k];
    if (met < 0) return true;
    const Index j = free[std::size_t(met)];
    x_[j] = direction[met] < 0 ? 0 : upper_[j];
    state(j) = direction[met] < 0 ? State::kLower : State::kUpper;
    return false;
  }

  VectorXd length_, inverse_;
  MatrixXd gram_;
  VectorXd atb_, upper_, x_;
  std::vector<State> state_;
  double tolerance_;
  int iterations_ = 0;
};

}  // namespace

BoundedLeastSquares bounded_least_squares(const MatrixXd& gram, const VectorXd& atb, const VectorXd& upper) {
  if (atb.size() == 0) return {};
  BoundedLeastSquares result = ActiveSet(gram, atb, upper).solve();
  result.x = result.x.cwiseMax(0).cwiseMin(upper);
  return result;
}

}  // namespace chiaro::inverse::numerics
