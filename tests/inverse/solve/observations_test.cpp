#include "inverse/solve/observations.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using tests::DirectProblem;
using tests::known_lights;

// Five places, three of them of lights that shine; some intensities are 0 in one channel.
LightEstimates places() {
  LightEstimates lights = known_lights(3);
  lights[1].intensity[0] = 0;
  lights.push_back({{1.5, 2.5, 1.0}, {0, 0, 0}});
  lights.push_back({{3.5, 0.8, 2.0}, {0, 0, 0}});
  return lights;
}

TEST(FitIntensities, RecoversThoseThatMadeTheTarget) {
  const DirectProblem problem(places());
  const auto columns = evaluate_columns(problem.response(), places(), Evaluation::kTracedVisibility);
  const IntensityFit fit = fit_intensities(problem.observations(), columns);
  ASSERT_EQ(fit.intensity.size(), 5U);
  for (std::size_t j = 0; j < 5; ++j) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fit.intensity[j][c], places()[j].intensity[c], 1e-6);
  }
  EXPECT_LE(fit.kkt_residual, 1e-9);
}

TEST(FitIntensities, IsTheConstrainedMinimumOfANoisyTarget) {
  DirectProblem problem(places());
  Observations observations = problem.observations();
  for (Eigen::Index i = 0; i < observations.wanted.rows(); ++i) {
    renderer::Sampler sampler(1, std::uint32_t(i), 0);
    for (int c = 0; c < 3; ++c) observations.wanted(i, c) += 0.5 * (double(sampler.next_1d()) - 0.7);
    observations.sqrt_weight[i] = i % 5 == 0 ? 0 : 0.2 + double(sampler.next_1d());
  }
  const LightEstimates start = places();
  const auto columns = evaluate_columns(problem.response(), start, Evaluation::kTracedVisibility);
  const IntensityFit fit = fit_intensities(observations, columns);
  LightEstimates lights = start;
  for (std::size_t j = 0; j < 5; ++j) lights[j].intensity = fit.intensity[j];
  const Column residual = observations.wanted - total_illumination(columns, lights, observations.wanted.rows());
  // Karush–Kuhn–Tucker, from the definition: the slope is 0 where a light shines, and not upwards where it does not.
  int dark = 0;
  for (std::size_t j = 0; j < 5; ++j) {
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd a = observations.sqrt_weight.cwiseProduct(columns[j].col(c));
      const Eigen::VectorXd r = observations.sqrt_weight.cwiseProduct(residual.col(c));
      const double slope = a.dot(r) / (a.norm() * observations.wanted.norm());
      ASSERT_GE(fit.intensity[j][c], 0);
      if (fit.intensity[j][c] > 0) {
        EXPECT_NEAR(slope, 0, 1e-9);
      } else {
        EXPECT_LE(slope, 1e-9);
        ++dark;
      }
    }
  }
  EXPECT_GT(dark, 0);
}

TEST(Observations, ErrorsAndContributionsAreTheirDefinitions) {
  Observations o;
  o.wanted = Column::Zero(2, 3);
  o.wanted.row(0) << 3, 0, 0;
  o.wanted.row(1) << 0, 4, 0;
  o.sqrt_weight = Eigen::Vector2d(1, 0.5);
  o.target_norm = 10;
  EXPECT_NEAR(relative_error(o, o.wanted), 0, 1e-15);
  EXPECT_NEAR(relative_error(o, Column::Zero(2, 3)), std::sqrt(9.0 + 4.0) / 10, 1e-12);
  Column column = Column::Ones(2, 3);
  // √(Σ_c l_c² (1 + ¼))
  EXPECT_NEAR(contribution_norm(o, column, {1, 2, 2}), std::sqrt(9 * 1.25), 1e-12);
  const LightEstimates lights{{{0, 0, 0}, {1, 2, 3}}, {{0, 0, 0}, {1, 0, 1}}};
  const Column sum = total_illumination({column, 2 * column}, lights, 2);
  EXPECT_EQ(sum(1, 0), 3);
  EXPECT_EQ(sum(1, 1), 2);
  EXPECT_EQ(sum(0, 2), 5);
}

TEST(Observations, RowsAreWhatSomeOfTheReceiversSay) {
  const LightEstimates lights = known_lights(2);
  const DirectProblem problem(lights);
  const std::vector<std::size_t> rows{3, 17, 90};
  Observations all = problem.observations();
  all.standard_error.setConstant(0.01);
  const Observations some = rows_of(all, rows);
  ASSERT_EQ(some.wanted.rows(), 3);
  double squared = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(some.wanted.row(Eigen::Index(k)), all.wanted.row(Eigen::Index(rows[k])));
    squared += all.target.row(Eigen::Index(rows[k])).squaredNorm();
  }
  EXPECT_NEAR(some.target_norm, std::sqrt(squared), 1e-12);
  EXPECT_NEAR(some.noise, std::sqrt(3 * 3 * 1e-4 / squared), 1e-12);
}

TEST(Observations, RelativeResidualsCountBrightAndDimReceiversAlike) {
  const DirectProblem problem(known_lights(2));
  const Observations& observations = problem.observations();
  const Eigen::VectorXd residuals = relative_residuals(observations, 1.1 * observations.wanted);
  const Eigen::VectorXd brightness = observations.target.rowwise().norm();
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    // Of those darker than a tenth of the mean the error counts as if they were as bright as that.
    const double share = std::min(1.0, brightness[i] / (0.1 * brightness.mean()));
    EXPECT_NEAR(residuals[i], 0.1 * share, 1e-12);
  }
}

// Paint on black: a pool on one receiver of a hundred is not what has to be made darker.
TEST(Observations, CapsAreOfTheReceiversThatAreLit) {
  Observations observations;
  observations.target = Column::Zero(1000, 3);
  for (int i = 0; i < 10; ++i) observations.target.row(100 * i).setConstant(i == 9 ? 40 : 1);
  observations.wanted = observations.target;
  observations.sqrt_weight = observations.stands_for = Eigen::VectorXd::Ones(1000);
  observations.standard_error = Eigen::VectorXd::Zero(1000);
  observations.measure_target();
  const Observations capped = with_capped_weights(observations);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(capped.sqrt_weight[100 * i], 1) << i;
  EXPECT_EQ(capped.target_norm, observations.target_norm);
  observations.target.topRows(400).setOnes();
  observations.target.row(900).setConstant(40);
  const Observations of_many = with_capped_weights(observations);
  EXPECT_EQ(of_many.sqrt_weight[0], 1);
  EXPECT_NEAR(of_many.sqrt_weight[900], 1.0 / 40, 1e-12);
}

}  // namespace
}  // namespace chiaro::inverse
