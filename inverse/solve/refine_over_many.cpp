// Gauss–Newton steps with weights by the residuals (iteratively reweighted least squares). Visibility is held during a
// step. Receivers whose shadow is not where the target has it say nothing about which way to go, and would pull the
// lights aside: their residuals are far beyond those of all others, and weigh little.
// Source: Holland, Welsch, Robust Regression Using Iteratively Reweighted Least-Squares, 1977 (weights after Geman and
// McClure, 1987).

#include "inverse/solve/refine_over_many.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr int kRounds = 3, kSteps = 12;
constexpr double kAtRest = 1e-4;                // of the region's diagonal, after a round
constexpr double kStepAtRest = 1e-5;            // of the region's diagonal
constexpr double kLongestStep = 0.01;           // of the region's diagonal
constexpr double kOutlier = 3;                  // medians
constexpr double kFirefly = 10;                 // medians
constexpr double kLeastScale = 1e-3;            // of a receiver's brightness
constexpr double kDark = 0.1;                   // brightness that residuals are compared with at least, in means of all
constexpr std::size_t kPathsPerSample = 16000;  // of all receivers together, over rays per receiver of the bake
constexpr int kLeastPaths = 16, kMostPaths = 8192;  // per receiver
constexpr double kDamping = 1e-9;                   // of the normal matrix' diagonal

std::vector<ColumnWithGradient> columns_of(const LightResponse& response, const LightEstimates& lights) {
  std::vector<ColumnWithGradient> columns(lights.size());
  renderer::parallel_for(lights.size(), [&](std::size_t j) {
    columns[j] = response.evaluate_with_gradient(lights[j].position, VisibilitySource::kTraced);
  });
  return columns;
}

// All light that reaches the receivers, but for what comes straight from `lights`. Theirs by many bounces is in it too,
// and does not vary with their intensities while they are fitted: noise in what varies would dim them.
Column light_beside(const ManyReceivers& many, const LightEstimates& lights, const LightEstimates& others) {
  renderer::Lights all;
  for (const LightEstimates* some : {&lights, &others}) {
    for (const LightEstimate& estimate : *some) all.emplace_back(point_light(estimate));
  }
  const std::vector<renderer::SurfaceSample>& at = many.response.receivers();
  const std::size_t paths = kPathsPerSample * std::size_t(many.settings.samples) / at.size();
  const renderer::TraceOptions trace{std::clamp(int(paths), kLeastPaths, kMostPaths), many.settings.bounces,
                                     many.settings.seed, false};
  const std::vector<Vec3f> traced = trace_illumination(many.tracer, at, all, trace, many.control).value;
  Column beside(Eigen::Index(at.size()), 3);
  for (std::size_t i = 0; i < at.size(); ++i) beside.row(Eigen::Index(i)) = to_eigen(traced[i]).transpose();
  for (const LightEstimate& light : lights) {
    beside -= many.response.direct(light.position) * light.intensity.matrix().asDiagonal();
  }
  return beside;
}

double median(Eigen::VectorXd values) {
  const auto middle = values.data() + values.size() / 2;
  std::nth_element(values.data(), middle, values.data() + values.size());
  return *middle;
}

Column residual_of(const Observations& observations, const std::vector<ColumnWithGradient>& columns,
                   const LightEstimates& lights) {
  Column residual = -observations.wanted;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    residual += columns[j].value * lights[j].intensity.matrix().asDiagonal();
  }
  return residual;
}

// Of receivers whose residuals are beyond so many medians little is left.
Eigen::VectorXd robust_sqrt_weight(const Observations& observations, const Column& residual, double outlier) {
  const Eigen::ArrayXd brightness = observations.target.rowwise().norm();
  const Eigen::ArrayXd relative = residual.rowwise().norm().array() / brightness.max(kDark * brightness.mean());
  const double scale = std::max(kLeastScale, outlier * median(relative));
  return observations.sqrt_weight.array() / (1 + (relative / scale).square());
}

// Unknowns: x, y, z of each light, then red, green, blue of each.
Eigen::VectorXd gauss_newton_step(const std::vector<ColumnWithGradient>& columns, const LightEstimates& lights,
                                  const Column& residual, const Eigen::VectorXd& sqrt_weight) {
  const auto n = Eigen::Index(lights.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(6 * n);
  for (int c = 0; c < 3; ++c) {
    Eigen::MatrixXd jacobian(residual.rows(), 4 * n);
    std::vector<Eigen::Index> unknown(std::size_t(4 * n));
    for (Eigen::Index j = 0; j < n; ++j) {
      const ColumnWithGradient& column = columns[std::size_t(j)];
      for (int a = 0; a < 3; ++a) {
        jacobian.col(3 * j + a) =
            lights[std::size_t(j)].intensity[c] * sqrt_weight.cwiseProduct(column.gradient[a].col(c));
        unknown[std::size_t(3 * j + a)] = 3 * j + a;
      }
      jacobian.col(3 * n + j) = sqrt_weight.cwiseProduct(column.value.col(c));
      unknown[std::size_t(3 * n + j)] = 3 * n + 3 * j + c;
    }
    const Eigen::VectorXd weighted = sqrt_weight.cwiseProduct(residual.col(c));
    normal(unknown, unknown) += jacobian.transpose() * jacobian;
    gradient(unknown) += jacobian.transpose() * weighted;
  }
  normal.diagonal() *= 1 + kDamping;
  // A light that has no effect has no row.
  for (Eigen::Index k = 0; k < 6 * n; ++k) normal(k, k) += normal(k, k) > 0 ? 0 : 1;
  return -normal.ldlt().solve(gradient);
}

// As far as the step goes, within the region and the longest step; true: it moved.
bool take(const Eigen::VectorXd& step, const Box3f& region, LightEstimates& lights) {
  const double diagonal = double(region.diagonal());
  double longest = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    longest = std::max(longest, step.segment<3>(Eigen::Index(3 * j)).norm());
  }
  const double part = std::min(1.0, kLongestStep * diagonal / std::max(longest, 1e-300));
  for (std::size_t j = 0; j < lights.size(); ++j) {
    LightEstimate& light = lights[j];
    light.position = (light.position + part * step.segment<3>(Eigen::Index(3 * j)))
                         .cwiseMax(to_eigen(region.min))
                         .cwiseMin(to_eigen(region.max));
    const auto change = step.segment<3>(Eigen::Index(3 * (lights.size() + j)));
    light.intensity = (light.intensity + part * change.array()).max(0);
  }
  return longest > kStepAtRest * diagonal;
}

void descend(const LightResponse& response, const Observations& observations, LightEstimates& lights) {
  for (int k = 0; k < kSteps; ++k) {
    const std::vector<ColumnWithGradient> columns = columns_of(response, lights);
    const Column residual = residual_of(observations, columns, lights);
    const Eigen::VectorXd step =
        gauss_newton_step(columns, lights, residual, robust_sqrt_weight(observations, residual, kOutlier));
    if (!step.allFinite() || !take(step, response.grid().region, lights)) return;
  }
}

}  // namespace

TransportCache direct_transport(const LightGrid& grid, std::size_t receivers) {
  TransportCache direct;
  direct.grid.region = grid.region;
  direct.grid.counts = {1, 1, 1};
  direct.grid.light_of_node = {0};
  direct.grid.positions = {(grid.region.min + grid.region.max) / 2};
  direct.receiver_count = receivers;
  direct.visibility.resize(receivers);
  direct.indirect.resize(receivers);
  return direct;
}

PolishedLights refine_over_many(const ManyReceivers& many, const LightEstimates& start, const LightEstimates& others) {
  PolishedLights refined;
  for (const LightEstimate& light : start) refined.lights.push_back({light.position, light.intensity});
  if (start.empty() || many.response.receiver_count() == 0) return refined;
  double move = std::numeric_limits<double>::infinity();
  while (move > kAtRest * double(many.response.grid().region.diagonal()) && refined.rounds < kRounds) {
    const LightEstimates before = refined.lights;
    Observations observations = many.observations;
    observations.wanted -= light_beside(many, refined.lights, others);
    descend(many.response, observations, refined.lights);
    // Noise is not symmetric, and weights by residuals take its mean off: none but fireflies lose weight here.
    const std::vector<Column> columns = evaluate_columns(many.response, refined.lights, VisibilitySource::kTraced);
    Observations fitted = observations;
    const Column left = total_illumination(columns, refined.lights, observations.wanted.rows()) - observations.wanted;
    fitted.sqrt_weight = robust_sqrt_weight(observations, left, kFirefly);
    const IntensityFit fit = fit_intensities(fitted, columns);
    for (std::size_t j = 0; j < before.size(); ++j) refined.lights[j].intensity = fit.intensity[j];
    refined.error =
        relative_error(observations, total_illumination(columns, refined.lights, observations.wanted.rows()));
    move = largest_move(refined.lights, before);
    ++refined.rounds;
  }
  return refined;
}

}  // namespace chiaro::inverse
