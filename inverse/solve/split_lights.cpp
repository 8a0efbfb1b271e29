#include "inverse/solve/split_lights.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr double kDamping = 1e-9;      // of the normal matrix' diagonal
constexpr double kDifference = 0.005;  // of the region's diagonal, for second derivatives

// Σ residual · ∂²φ / ∂x∂x, by differences of gradients.
Eigen::Matrix3d curvature(const LightResponse& response, const Column& weighted_residual, const LightEstimate& light,
                          double step) {
  const Column pull = weighted_residual * light.intensity.matrix().asDiagonal();
  Eigen::Matrix3d second;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d offset = step * Eigen::Vector3d::Unit(a);
    const auto after =
        response.evaluate_with_gradient(Eigen::Vector3d(light.position + offset), Evaluation::kTracedVisibility);
    const auto before =
        response.evaluate_with_gradient(Eigen::Vector3d(light.position - offset), Evaluation::kTracedVisibility);
    for (int b = 0; b < 3; ++b) {
      second(a, b) = (after.gradient[b] - before.gradient[b]).cwiseProduct(pull).sum() / (2 * step);
    }
  }
  return (second + second.transpose()) / 2;
}

// Where the two parts of a light are tried, from where it stands along the direction in which it wants to part; of the
// region's diagonal.
constexpr std::array<std::array<double, 2>, 6> kParts{
    {{-0.02, 0.02}, {-0.06, 0.06}, {0, 0.04}, {0, -0.04}, {0, 0.08}, {0, -0.08}}};

// Where each channel by itself would have the light go: two lights of different colours pull it apart.
Eigen::Vector3d direction_of_colors(const LightResponse& response, const Eigen::VectorXd& sqrt_weight,
                                    const Column& weighted_residual, const LightEstimate& light) {
  const ColumnWithGradient here = response.evaluate_with_gradient(light.position, Evaluation::kTracedVisibility);
  Eigen::Matrix3d steps;
  for (int c = 0; c < 3; ++c) {
    Eigen::MatrixXd change(sqrt_weight.size(), 4);
    for (int a = 0; a < 3; ++a) change.col(a) = light.intensity[c] * here.gradient[a].col(c);
    change.col(3) = here.value.col(c);
    const Eigen::Vector4d gradient = change.transpose() * weighted_residual.col(c);
    change = sqrt_weight.asDiagonal() * change;
    Eigen::Matrix4d normal = change.transpose() * change;
    normal.diagonal() = normal.diagonal() * (1 + kDamping) + Eigen::Vector4d::Constant(1e-300);
    const Eigen::Vector4d step = -normal.ldlt().solve(gradient);
    steps.col(c) = step.allFinite() ? Eigen::Vector3d(step.head<3>()) : Eigen::Vector3d::Zero();
  }
  const Eigen::Matrix3d apart = steps.colwise() - steps.rowwise().mean().eval();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(apart * apart.transpose()).eigenvectors().col(2);
}

Split split_light(const LightResponse& response, const Observations& observations, const LightEstimates& lights,
                  std::vector<Column> columns, const Column& weighted_residual, std::size_t split) {
  const double diagonal = double(response.grid().region.diagonal());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
      curvature(response, weighted_residual, lights[split], kDifference * diagonal));
  const std::array<Eigen::Vector3d, 2> directions{
      eigen.eigenvectors().col(0),
      direction_of_colors(response, observations.sqrt_weight, weighted_residual, lights[split])};
  const auto part = [&](const Eigen::Vector3d& side) {
    LightEstimate light = lights[split];
    light.position = response.places().nearest(light.position + diagonal * side).value_or(light.position);
    return light;
  };
  columns.emplace_back();
  Split best{{}, split, std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector3d& direction : directions) {
    for (const auto& [one, other] : kParts) {
      Split tried{lights, split};
      tried.lights[split] = part(one * direction);
      tried.lights.push_back(part(other * direction));
      columns[split] = evaluate_column(response, tried.lights[split], Evaluation::kTracedVisibility);
      columns.back() = evaluate_column(response, tried.lights.back(), Evaluation::kTracedVisibility);
      tried.error = refit_intensities(observations, columns, tried.lights);
      if (tried.error < best.error) best = std::move(tried);
    }
  }
  return best;
}

}  // namespace

std::vector<Split> propose_splits(const LightResponse& response, const Observations& observations,
                                  const LightEstimates& lights, std::size_t most) {
  const std::vector<Column> columns = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
  const Column residual = total_illumination(columns, lights, observations.wanted.rows()) - observations.wanted;
  const Column weighted = observations.sqrt_weight.cwiseAbs2().asDiagonal() * residual;
  std::vector<Split> splits(lights.size());
  renderer::parallel_for(lights.size(), [&](std::size_t j) {
    splits[j] = split_light(response, observations, lights, columns, weighted, j);
  });
  return best_of(std::move(splits), most);
}

}  // namespace chiaro::inverse
