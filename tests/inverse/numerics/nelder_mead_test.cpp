#include "inverse/numerics/nelder_mead.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

VectorXd all(int n, double value) { return VectorXd::Constant(n, value); }

NelderMeadResult minimise_freely(const std::function<double(const VectorXd&)>& f, const VectorXd& x0,
                                 const NelderMeadOptions& options = {}) {
  const int n = int(x0.size());
  return nelder_mead(f, x0, all(n, 0.5), all(n, -kInfinity), all(n, kInfinity), options);
}

double rosenbrock(const VectorXd& x) { return 100 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1 - x[0], 2); }

TEST(NelderMead, Rosenbrock) {
  const NelderMeadResult result = minimise_freely(rosenbrock, Eigen::Vector2d(-1.2, 1));
  EXPECT_TRUE(result.converged);
  EXPECT_LE((result.x - all(2, 1)).norm(), 1e-5);
  EXPECT_DOUBLE_EQ(result.value, rosenbrock(result.x));
}

TEST(NelderMead, QuadraticInTwelveDimensions) {
  const VectorXd centre = VectorXd::LinSpaced(12, -1, 1);
  const auto f = [&](const VectorXd& x) {
    double sum = 3;
    for (int i = 0; i < 12; ++i) sum += (1 + i) * std::pow(x[i] - centre[i], 2);
    return sum;
  };
  const NelderMeadResult result = minimise_freely(f, all(12, 0.3), {.max_evaluations = 20000});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.value, 3, 1e-7);
  EXPECT_LE((result.x - centre).norm(), 1e-3);
}

TEST(NelderMead, OneDimension) {
  const auto f = [](const VectorXd& x) { return std::cosh(x[0] - 4); };
  const NelderMeadResult result = minimise_freely(f, all(1, 0));
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.x[0], 4, 1e-3);
}

TEST(NelderMead, AMinimumOfZeroValueEnds) {
  const auto f = [](const VectorXd& x) { return (x - all(2, 0.3)).squaredNorm(); };
  const NelderMeadResult result = minimise_freely(f, all(2, 5), {.max_evaluations = 100000});
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.evaluations, 5000);
  EXPECT_LE((result.x - all(2, 0.3)).norm(), 1e-9);
}

TEST(NelderMead, ActiveBoundsAreReachedAndNeverCrossed) {
  const VectorXd lower = Eigen::Vector3d(0, -1, -2), upper = Eigen::Vector3d(2, 1, 2);
  bool crossed = false;
  const auto f = [&](const VectorXd& x) {
    crossed = crossed || (x.array() < lower.array()).any() || (x.array() > upper.array()).any();
    return 1 + (x - Eigen::Vector3d(-3, 5, 0.5)).squaredNorm();
  };
  const NelderMeadResult result = nelder_mead(f, Eigen::Vector3d(1, 0, 1.9), all(3, 0.7), lower, upper);
  EXPECT_FALSE(crossed);
  EXPECT_TRUE(result.converged);
  EXPECT_LE((result.x - Eigen::Vector3d(0, 1, 0.5)).norm(), 1e-3);
}

TEST(NelderMead, AStartOutsideTheBoundsOrOnThemIsFine) {
  const auto f = [](const VectorXd& x) { return 1 + (x - all(2, 0.5)).squaredNorm(); };
  for (const double start : {-7.0, 0.0, 1.0, 9.0}) {
    const NelderMeadResult result = nelder_mead(f, all(2, start), all(2, 3), all(2, 0), all(2, 1));
    EXPECT_LE((result.x - all(2, 0.5)).norm(), 1e-3) << start;
  }
}

TEST(NelderMead, ParametersWithEqualBoundsStay) {
  const auto f = [](const VectorXd& x) { return 1 + x.squaredNorm(); };
  const VectorXd lower = Eigen::Vector3d(-5, 2, -5), upper = Eigen::Vector3d(5, 2, 5);
  const NelderMeadResult result = nelder_mead(f, all(3, 1), all(3, 0.5), lower, upper);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.x[1], 2);
  EXPECT_NEAR(result.value, 5, 1e-7);
  const NelderMeadResult fixed = nelder_mead(f, all(1, 1), all(1, 1), all(1, 3), all(1, 3));
  EXPECT_EQ(fixed.value, 10);
  EXPECT_EQ(fixed.evaluations, 1);
  EXPECT_TRUE(fixed.converged);
}

TEST(NelderMead, RegionsWithoutAValueAreAvoided) {
  const auto f = [](const VectorXd& x) {
    if (x[0] < 0) return double(NAN);
    if (x[1] < 0) return -kInfinity;
    return 1 + std::pow(x[0] - 0.1, 2) + std::pow(x[1] - 0.1, 2);
  };
  const NelderMeadResult result = minimise_freely(f, all(2, 2));
  EXPECT_TRUE(result.converged);
  EXPECT_LE((result.x - all(2, 0.1)).norm(), 1e-3);
}

TEST(NelderMead, WithoutAnyValueItEndsAndSaysSo) {
  const NelderMeadResult result = minimise_freely([](const VectorXd&) { return double(NAN); }, all(2, 1));
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.value, kInfinity);
  EXPECT_TRUE(result.x.allFinite());
}

TEST(NelderMead, EvaluationsAreCountedAndLimited) {
  for (const int limit : {1, 2, 10, 57}) {
    int calls = 0;
    double best = kInfinity;
    const auto f = [&](const VectorXd& x) {
      ++calls;
      best = std::min(best, rosenbrock(x));
      return rosenbrock(x);
    };
    const NelderMeadResult result = minimise_freely(f, Eigen::Vector2d(-1.2, 1), {.max_evaluations = limit});
    EXPECT_EQ(calls, limit);
    EXPECT_EQ(result.evaluations, limit);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.value, best);
  }
}

TEST(NelderMead, StopsWhenAskedTo) {
  int steps = 0;
  const NelderMeadResult stopped =
      minimise_freely(rosenbrock, Eigen::Vector2d(-1.2, 1), {.stop = [&] { return ++steps > 5; }});
  EXPECT_EQ(steps, 6);
  EXPECT_FALSE(stopped.converged);
  EXPECT_LT(stopped.evaluations, 30);
  EXPECT_LE(stopped.value, rosenbrock(Eigen::Vector2d(-1.2, 1)));
}

TEST(NelderMead, ARestartNeverMakesItWorse) {
  const NelderMeadResult once = minimise_freely(rosenbrock, Eigen::Vector2d(-1.2, 1), {.restart = false});
  const NelderMeadResult twice = minimise_freely(rosenbrock, Eigen::Vector2d(-1.2, 1));
  EXPECT_LE(twice.value, once.value);
  EXPECT_GT(twice.evaluations, once.evaluations);
}

TEST(NelderMead, RefusesArgumentsThatMakeNoSense) {
  const auto f = [](const VectorXd& x) { return x.sum(); };
  EXPECT_THROW(nelder_mead(f, all(2, 0), all(1, 1), all(2, 0), all(2, 1)), std::invalid_argument);
  EXPECT_THROW(nelder_mead(f, all(2, NAN), all(2, 1), all(2, 0), all(2, 1)), std::invalid_argument);
  EXPECT_THROW(nelder_mead(f, all(2, 0), all(2, 0), all(2, 0), all(2, 1)), std::invalid_argument);
  EXPECT_THROW(nelder_mead(f, all(2, 0), all(2, 1), all(2, 1), all(2, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
