#include "inverse/solve/fit_traced_columns.h"

#include <random>

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

constexpr Eigen::Index kReceivers = 4000;

Column random_column(std::mt19937& random, double least, double most) {
  std::uniform_real_distribution<double> uniform(least, most);
  return Column::NullaryExpr(kReceivers, 3, [&] { return uniform(random); });
}

// Noise as large as the column.
Column noisy(const Column& column, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return column + Column::NullaryExpr(kReceivers, 3, [&] { return 0.8 * normal(random); });
}

std::vector<Column> noisy(const std::vector<Column>& columns, std::mt19937& random) {
  std::vector<Column> all;
  for (const Column& column : columns) all.push_back(noisy(column, random));
  return all;
}

Observations observations_of(const Column& wanted) {
  Observations observations;
  observations.wanted = observations.target = wanted;
  observations.sqrt_weight = observations.stands_for = Eigen::VectorXd::Ones(kReceivers);
  observations.standard_error = Eigen::VectorXd::Zero(kReceivers);
  observations.measure_target();
  return observations;
}

TEST(FitTracedColumns, NoiseDoesNotDimTheLights) {
  std::mt19937 random(3);
  const std::vector<Column> exact{random_column(random, 0, 2), random_column(random, 0, 2)};
  const Observations observations = observations_of(5 * exact[0] + 2 * exact[1]);
  const std::vector<Column> columns = noisy(exact, random), again = noisy(exact, random);
  const IntensityFit fit = fit_traced_columns(observations, columns, again);
  const IntensityFit dimmed = fit_intensities(observations, columns);
  for (int c = 0; c < 3; ++c) {
    // Residuals of 4.3 over columns that vary by 0.58, in 4000 receivers: a standard error of 0.12.
    EXPECT_NEAR(fit.intensity[0][c], 5, 0.5);
    EXPECT_NEAR(fit.intensity[1][c], 2, 0.5);
    EXPECT_LT(dimmed.intensity[0][c], 4.2);
  }
}

TEST(FitTracedColumns, IsTheLeastSquaresFitWithoutNoise) {
  std::mt19937 random(4);
  const std::vector<Column> exact{random_column(random, 0, 1), random_column(random, 0, 1e-6)};
  const Observations observations = observations_of(random_column(random, 0, 1));
  const IntensityFit fit = fit_traced_columns(observations, exact, exact), plain = fit_intensities(observations, exact);
  for (std::size_t j = 0; j < 2; ++j) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fit.intensity[j][c] / plain.intensity[j][c], 1, 1e-6);
  }
}

// Two lights in one place, of which only the sum is known, and a third that brings nothing or next to nothing.
TEST(FitTracedColumns, LightsThatCannotBeToldStayBounded) {
  std::mt19937 random(5);
  const Column place = random_column(random, 0, 2);
  const Observations observations = observations_of(3 * place);
  for (const double brings : {0.0, 1e-9}) {
    for (const bool with_noise : {false, true}) {
      const std::vector<Column> exact{place, place, Column::Constant(kReceivers, 3, brings)};
      std::vector<Column> columns = with_noise ? noisy(exact, random) : exact;
      std::vector<Column> again = with_noise ? noisy(exact, random) : exact;
      columns[2] = again[2] = exact[2];
      const IntensityFit fit = fit_traced_columns(observations, columns, again);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(fit.intensity[0][c] + fit.intensity[1][c], 3, 0.3);
        EXPECT_GE(std::min(fit.intensity[0][c], fit.intensity[1][c]), 0);
        EXPECT_LT(fit.intensity[2][c] * brings, 0.3);
      }
    }
  }
}

}  // namespace
}  // namespace chiaro::inverse
