// Gauss–Newton steps with weights by the residuals (iteratively reweighted least squares). Visibility is held during a
// step. Receivers whose shadow is not where the target has it say nothing about which way to go, and would pull the
// lights aside: their residuals are far beyond those of all others, and weigh little.
// Light by bounces is noisy, and least squares would dim what noise varies with: the residuals are made orthogonal to
// the derivatives of direct light, which has none, and not to those of all light (instrumental variables).
// Sources: Reiersøl, Confluence Analysis by Means of Instrumental Sets of Variables, 1945; Holland, Welsch, Robust
// Regression Using Iteratively Reweighted Least-Squares, 1977 (weights after Geman and McClure, 1987).

#include "inverse/solve/refine_over_many.h"

#include <algorithm>

#include <Eigen/LU>

#include "inverse/numerics/median.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {
namespace {

constexpr int kDraftRounds = 5, kSteps = 12;
constexpr double kStepAtRest = 1e-5;            // of the region's diagonal
constexpr double kLongestStep = 0.01;           // of the region's diagonal
constexpr double kOutlier = 3;                  // medians
constexpr double kFirefly = 10;                 // medians
constexpr double kLeastScale = 1e-3;            // of a receiver's brightness
constexpr double kDark = 0.1;                   // brightness that residuals are compared with at least, in means of all
constexpr double kNear = 2e-3;                  // of the region's diagonal: indirect light hardly changes
constexpr std::size_t kPathsPerSample = 16000;  // of all receivers together, over rays per receiver of the bake …
constexpr std::size_t kDraft = 8;               // … and a part of them while the lights still move farther
constexpr int kLeastPaths = 4, kMostPaths = 8192;  // per receiver
constexpr double kDarkest = 1e-20;                 // candela: a channel that shines
constexpr double kDamping = 1e-9;                  // of the normal matrix' diagonal

// The light that comes by bounces where the lights stand now. It is path traced, and noisy.
struct TracedIndirect {
  std::vector<Column> unity;  // of each light of 1 cd
  Column others;              // all light of the others, their direct light too
};

// paths_per_sample: of all receivers together, over rays per receiver of the bake.
TracedIndirect trace_indirect(const ManyReceivers& many, const LightEstimates& lights, const LightEstimates& others,
                              std::size_t paths_per_sample) {
  renderer::Lights all;
  for (const LightEstimates* some : {&lights, &others}) {
    for (const LightEstimate& estimate : *some) all.emplace_back(point_light(estimate));
  }
  const std::vector<renderer::SurfaceSample>& at = many.response.receivers();
  const std::size_t paths = paths_per_sample * std::size_t(many.settings.samples) / at.size();
  const renderer::TraceOptions trace{std::clamp(int(paths), kLeastPaths, kMostPaths), many.settings.bounces,
                                     many.settings.seed, false};
  const auto traced = trace_illumination_per_light(many.tracer, at, all, trace, many.control);
  TracedIndirect indirect{{}, Column::Zero(Eigen::Index(at.size()), 3)};
  for (std::size_t j = 0; j < lights.size(); ++j) {
    // Of a channel that does not shine nothing is known, and its indirect light counts as none.
    const auto shines = (lights[j].intensity > kDarkest).eval();
    const Eigen::Array3d per_candela = shines.select(lights[j].intensity.inverse(), 0);
    const Column unity = column_of(traced[j]) * per_candela.matrix().asDiagonal();
    indirect.unity.push_back(unity -
                             many.response.direct(lights[j].position) * shines.cast<double>().matrix().asDiagonal());
  }
  for (std::size_t l = lights.size(); l < all.size(); ++l) indirect.others += column_of(traced[l]);
  return indirect;
}

Column residual_of(const Observations& observations, const std::vector<ColumnWithGradient>& direct,
                   const std::vector<Column>& indirect, const LightEstimates& lights) {
  Column residual = -observations.wanted;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    residual += (direct[j].value + indirect[j]) * lights[j].intensity.matrix().asDiagonal();
  }
  return residual;
}

// Of receivers whose residuals are beyond so many medians little is left.
Eigen::VectorXd robust_sqrt_weight(const Observations& observations, const Column& residual, double outlier) {
  const Eigen::ArrayXd brightness = observations.target.rowwise().norm();
  const Eigen::ArrayXd relative = residual.rowwise().norm().array() / brightness.max(kDark * brightness.mean());
  const double scale = std::max(kLeastScale, outlier * numerics::median({relative.begin(), relative.end()}));
  return observations.sqrt_weight.array() / (1 + (relative / scale).square());
}

// Unknowns: x, y, z of each light, then red, green, blue of each. Instruments are the derivatives of direct light.
Eigen::VectorXd gauss_newton_step(const std::vector<ColumnWithGradient>& direct, const std::vector<Column>& indirect,
                                  const LightEstimates& lights, const Column& residual,
                                  const Eigen::VectorXd& sqrt_weight) {
  const auto n = Eigen::Index(lights.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(6 * n);
  for (int c = 0; c < 3; ++c) {
    Eigen::MatrixXd instruments(residual.rows(), 4 * n);
    Eigen::MatrixXd by_bounces(residual.rows(), n);
    std::vector<Eigen::Index> unknown(std::size_t(4 * n));
    for (Eigen::Index j = 0; j < n; ++j) {
      const ColumnWithGradient& column = direct[std::size_t(j)];
      for (int a = 0; a < 3; ++a) {
        instruments.col(3 * j + a) =
            lights[std::size_t(j)].intensity[c] * sqrt_weight.cwiseProduct(column.gradient[a].col(c));
        unknown[std::size_t(3 * j + a)] = 3 * j + a;
      }
      instruments.col(3 * n + j) = sqrt_weight.cwiseProduct(column.value.col(c));
      by_bounces.col(j) = sqrt_weight.cwiseProduct(indirect[std::size_t(j)].col(c));
      unknown[std::size_t(3 * n + j)] = 3 * n + 3 * j + c;
    }
    Eigen::MatrixXd products = instruments.transpose() * instruments;
    products.rightCols(n) += instruments.transpose() * by_bounces;
    normal(unknown, unknown) += products;
    gradient(unknown) += instruments.transpose() * sqrt_weight.cwiseProduct(residual.col(c));
  }
  normal.diagonal() *= 1 + kDamping;
  // A light that has no effect has no row.
  for (Eigen::Index k = 0; k < 6 * n; ++k) normal(k, k) += normal(k, k) > 0 ? 0 : 1;
  return -normal.partialPivLu().solve(gradient);
}

// As far as the step goes, within the region and the longest step; true: it moved.
bool take(const Eigen::VectorXd& step, const LightResponse& response, LightEstimates& lights) {
  const double diagonal = double(response.grid().region.diagonal());
  double longest = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    longest = std::max(longest, step.segment<3>(Eigen::Index(3 * j)).norm());
  }
  const double part = std::min(1.0, kLongestStep * diagonal / std::max(longest, 1e-300));
  for (std::size_t j = 0; j < lights.size(); ++j) {
    LightEstimate& light = lights[j];
    const Eigen::Vector3d moved = light.position + part * step.segment<3>(Eigen::Index(3 * j));
    light.position = response.places().nearest(moved).value_or(light.position);
    const auto change = step.segment<3>(Eigen::Index(3 * (lights.size() + j)));
    light.intensity = (light.intensity + part * change.array()).max(0);
  }
  return longest > kStepAtRest * diagonal;
}

void descend(const LightResponse& response, const Observations& observations, const std::vector<Column>& indirect,
             LightEstimates& lights) {
  for (int k = 0; k < kSteps; ++k) {
    const std::vector<ColumnWithGradient> direct = evaluate_columns_with_gradient(response, lights);
    const Column residual = residual_of(observations, direct, indirect, lights);
    const Eigen::VectorXd weight = robust_sqrt_weight(observations, residual, kOutlier);
    const Eigen::VectorXd step = gauss_newton_step(direct, indirect, lights, residual, weight);
    if (!step.allFinite() || !take(step, response, lights)) return;
  }
}

// A light whose indirect light stayed behind while it moved is led past its place in one round and back in the next.
// The ratio of both moves tells where it would come to rest (Aitken's Δ²).
// earlier: before the round before; empty in the first.
void come_to_rest(const AllowedPlaces& places, const LightEstimates& earlier, const LightEstimates& before,
                  LightEstimates& lights) {
  for (std::size_t j = 0; j < earlier.size(); ++j) {
    const Eigen::Vector3d last_move = before[j].position - earlier[j].position;
    const Eigen::Vector3d move = lights[j].position - before[j].position;
    const double ratio = move.dot(last_move) / std::max(last_move.squaredNorm(), 1e-300);
    if (!(ratio < 0 && ratio > -1)) continue;
    const Eigen::Vector3d at_rest = before[j].position + move / (1 - ratio);
    lights[j].position = places.nearest(at_rest).value_or(lights[j].position);
  }
}

// Intensities of one channel, none negative: those that would be are held at zero.
Eigen::VectorXd solve_with_instruments(const Eigen::MatrixXd& normal, const Eigen::VectorXd& wanted) {
  std::vector<Eigen::Index> lit;
  for (Eigen::Index j = 0; j < normal.rows(); ++j) {
    if (normal(j, j) > 0) lit.push_back(j);
  }
  Eigen::VectorXd intensity = Eigen::VectorXd::Zero(normal.rows());
  while (!lit.empty()) {
    const Eigen::VectorXd solution = normal(lit, lit).partialPivLu().solve(Eigen::VectorXd(wanted(lit)));
    if (solution.allFinite() && solution.minCoeff() >= 0) {
      intensity(lit) = solution;
      break;
    }
    Eigen::Index darkest = 0;
    if (solution.allFinite()) solution.minCoeff(&darkest);
    lit.erase(lit.begin() + darkest);
  }
  return intensity;
}

// With weights that residuals cannot take the mean off by: noise is not symmetric, and none but fireflies lose weight.
// Returns the relative error left.
double fit_brightness(const ManyReceivers& many, const Observations& observations, const std::vector<Column>& indirect,
                      LightEstimates& lights) {
  const std::vector<Column> direct = evaluate_columns(many.response, lights, Evaluation::kTracedVisibility);
  std::vector<Column> all = direct;
  for (std::size_t j = 0; j < lights.size(); ++j) all[j] += indirect[j];
  const Eigen::Index receivers = observations.wanted.rows(), n = Eigen::Index(lights.size());
  const Column left = total_illumination(all, lights, receivers) - observations.wanted;
  const Eigen::VectorXd weight = robust_sqrt_weight(observations, left, kFirefly).cwiseAbs2();
  for (int c = 0; c < 3; ++c) {
    Eigen::MatrixXd normal(n, n);
    Eigen::VectorXd wanted(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::VectorXd instrument = weight.cwiseProduct(direct[std::size_t(j)].col(c));
      for (Eigen::Index k = 0; k < n; ++k) normal(j, k) = instrument.dot(all[std::size_t(k)].col(c));
      wanted[j] = instrument.dot(observations.wanted.col(c));
    }
    const Eigen::VectorXd intensity = solve_with_instruments(normal, wanted);
    for (Eigen::Index j = 0; j < n; ++j) lights[std::size_t(j)].intensity[c] = intensity[j];
  }
  return relative_error(observations, total_illumination(all, lights, receivers));
}

// With indirect light as it is where the lights stand when it begins.
void refine_once(const ManyReceivers& many, const LightEstimates& others, std::size_t paths_per_sample,
                 PolishedLights& refined) {
  const TracedIndirect indirect = trace_indirect(many, refined.lights, others, paths_per_sample);
  Observations observations = many.observations;
  observations.wanted -= indirect.others;
  descend(many.response, observations, indirect.unity, refined.lights);
  refined.error = fit_brightness(many, observations, indirect.unity, refined.lights);
  ++refined.rounds;
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
  const double near = kNear * double(many.response.grid().region.diagonal());
  double move = std::numeric_limits<double>::infinity();
  LightEstimates earlier;
  while (move > near && refined.rounds < kDraftRounds) {
    const LightEstimates before = refined.lights;
    refine_once(many, others, kPathsPerSample / kDraft, refined);
    come_to_rest(many.response.places(), earlier, before, refined.lights);
    move = largest_move(refined.lights, before);
    earlier = before;
  }
  refine_once(many, others, kPathsPerSample, refined);
  return refined;
}

}  // namespace chiaro::inverse
