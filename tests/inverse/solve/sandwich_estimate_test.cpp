#include "inverse/solve/sandwich_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace chiaro::inverse {
namespace {

KnownDirections one_known() { return known_directions(Eigen::MatrixXd::Ones(1, 1)); }

// How often the interval of a mean, the first of whose values weighs so many times as much as each other, holds the
// truth. A value's residual is what it would leave if it were left out, as its leverage is its weight.
double coverage(int values, double first, int trials, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(values);
  weight[0] = first;
  weight /= weight.sum();
  int inside = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::ArrayXd value = Eigen::ArrayXd::NullaryExpr(values, [&] { return normal(random); });
    const double mean = (weight * value).sum();
    const Eigen::MatrixXd pulls = (weight * (value - mean) / (1 - weight)).matrix();
    inside += std::abs(mean) <= sandwich_estimate(pulls, one_known()).half_width(0) ? 1 : 0;
  }
  return double(inside) / trials;
}

// Of 10000 trials .9 come out as .9 ± .01 with a chance of 0.999. Degrees of freedom are not overestimated, so that
// intervals of few values are a little too wide; those of a normal distribution would hold four of them in .83.
TEST(SandwichEstimate, IntervalsHoldTheTruthHoweverFewSayOfIt) {
  for (const int values : {4, 10, 100}) {
    for (const double first : {1, 3}) {
      const double inside = coverage(values, first, 10000, 1);
      EXPECT_GT(inside, 0.89) << values << ' ' << first;
      EXPECT_LT(inside, 0.96) << values << ' ' << first;
    }
  }
}

TEST(SandwichEstimate, HalfWidthsAreStudents) {
  // Quantiles .95, Abramowitz and Stegun, table 26.10.
  const std::pair<double, double> quantiles[] = {{3, 2.353}, {5, 2.015}, {10, 1.812}, {60, 1.671}};
  for (const auto& [freedom, quantile] : quantiles) {
    const SandwichEstimate estimate{Eigen::MatrixXd::Constant(1, 1, 4), Eigen::VectorXd::Constant(1, freedom)};
    EXPECT_NEAR(estimate.half_width(0), 2 * quantile, 0.02) << freedom;
  }
}

TEST(SandwichEstimate, OfWhatIsNotKnownTheIntervalIsInfinite) {
  const KnownDirections directions = known_directions((Eigen::MatrixXd(2, 2) << 1, 0, 0, 0).finished());
  const SandwichEstimate estimate = sandwich_estimate((Eigen::MatrixXd(2, 2) << 1, 0, -1, 0).finished(), directions);
  EXPECT_TRUE(std::isfinite(estimate.half_width(0)));
  EXPECT_TRUE(std::isinf(estimate.half_width(1)));
  EXPECT_GE(estimate.freedom.minCoeff(), 1);
}

}  // namespace
}  // namespace chiaro::inverse
