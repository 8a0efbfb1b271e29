#include "inverse/solve/fit_in_place.h"

#include <algorithm>
#include <set>

#include "inverse/numerics/chosen_from.h"
#include "inverse/numerics/decompositions.h"
#include "inverse/solve/check_brightness.h"
#include "inverse/solve/check_lights_in_place.h"
#include "inverse/solve/fit_traced_columns.h"
#include "inverse/solve/known_directions.h"
#include "inverse/solve/light_intervals.h"
#include "inverse/solve/observe_target.h"
#include "inverse/solve/sandwich_estimate.h"
#include "inverse/solve/stage_clock.h"
#include "inverse/solve/traced_light.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kMany = 50000;       // receivers at most
constexpr int kLeastSamples = 64;          // paths per receiver
constexpr double kComparedPaths = 2e6;     // of all receivers, where intensities are to be told roughly …
constexpr int kLeastComparedSamples = 16;  // … and per receiver, from this to the least number otherwise
constexpr int kFewerAgain = 4;             // times as few, the second time
constexpr double kLeastOutside = 0.01;     // of what a receiver leaves, as far as the others decide it

renderer::Light with_intensity(renderer::Light light, Vec3f intensity) {
  intensity_of(light) = intensity;
  return light;
}

std::vector<Column> unity_columns(const SolveProblem& problem, const renderer::Lights& lights,
                                  const std::vector<renderer::SurfaceSample>& at, const renderer::TraceOptions& trace,
                                  const renderer::Control& control) {
  renderer::Lights unity;
  for (const renderer::Light& light : lights) unity.push_back(with_intensity(light, {1, 1, 1}));
  std::vector<Column> columns;
  const auto by_light = trace_illumination_by_light(problem.tracer, at, unity, trace, control);
  for (const auto& traced : by_light.of_light) {
    columns.push_back(column_of(traced));
  }
  return columns;
}

struct TracedColumns {
  std::vector<Column> columns, again;  // by other paths
};

TracedColumns trace_columns(const SolveProblem& problem, const renderer::Lights& lights,
                            const std::vector<renderer::SurfaceSample>& at, int paths, const SolveOptions& options,
                            const renderer::Control& control) {
  const auto traced = [&](int samples, std::uint64_t purpose) {
    return unity_columns(problem, lights, at, {samples, problem.bake.bounces, fresh_seed(options.seed, purpose), true},
                         control);
  };
  return {traced(paths, 6), traced(paths / kFewerAgain, 8)};
}

struct ChannelErrors {
  KnownDirections directions;
  SandwichEstimate of;  // the lights
};

// Of one channel's intensities, as light_intervals(). The columns' noise, which makes lights look unlike each other
// that are not, is not that of the same columns traced again: these are the instruments. In directions where next to
// nothing but noise is left nothing is known.
ChannelErrors errors_of_channel(const Observations& observations, const TracedColumns& traced, const Column& residual,
                                int channel) {
  const auto weighted = [&](const std::vector<Column>& columns) {
    Eigen::MatrixXd a(residual.rows(), Eigen::Index(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      a.col(Eigen::Index(j)) = observations.sqrt_weight.cwiseProduct(columns[j].col(channel));
    }
    return a;
  };
  const Eigen::MatrixXd instruments = weighted(traced.again), columns = weighted(traced.columns);
  const Eigen::MatrixXd product = instruments.transpose() * columns;
  const Eigen::MatrixXd with_noise = (instruments.transpose() * instruments + columns.transpose() * columns) / 2;
  const KnownDirections directions =
      known_directions(with_noise, [&](double eigenvalue, const Eigen::VectorXd& direction) {
        return direction.dot(product * direction) >= kLeastSure * eigenvalue;
      });
  const Eigen::MatrixXd& basis = directions.basis;
  const Eigen::MatrixXd inverse =
      basis * numerics::pseudoinverse(basis.transpose() * product * basis) * basis.transpose();
  // What each receiver would leave if it were left out of the fit, which the few beside a lamp lead to themselves.
  const Eigen::VectorXd leverage = (columns * inverse).cwiseProduct(instruments).rowwise().sum();
  const Eigen::VectorXd left = observations.sqrt_weight.cwiseProduct(residual.col(channel))
                                   .cwiseQuotient((1 - leverage.array()).max(kLeastOutside).matrix());
  return {directions, sandwich_estimate(left.asDiagonal() * instruments * inverse.transpose(), directions)};
}

// Half widths of intensities; of positions, which stay, none. Infinite where a light brings nothing.
LightIntervals intervals_of(const Observations& observations, const TracedColumns& traced,
                            const std::vector<Eigen::Array3d>& intensity) {
  const Column residual =
      total_illumination(traced.columns, intensity, observations.wanted.rows()) - observations.wanted;
  LightIntervals intervals{std::vector<LightInterval>(intensity.size(), {Eigen::Vector3d::Zero(), {}}), {}};
  std::set<std::pair<std::size_t, std::size_t>> confounded;
  for (int c = 0; c < 3; ++c) {
    const ChannelErrors errors = errors_of_channel(observations, traced, residual, c);
    for (std::size_t j = 0; j < intensity.size(); ++j) {
      intervals.lights[j].intensity[c] = errors.of.half_width(Eigen::Index(j));
    }
    find_confounded({errors.directions, errors.of.covariance, 0, 1}, intensity, c, confounded);
  }
  intervals.confounded.assign(confounded.begin(), confounded.end());
  return intervals;
}

double error_of(const Observations& observations, const std::vector<Column>& columns,
                const std::vector<Eigen::Array3d>& intensity) {
  return relative_error(observations, total_illumination(columns, intensity, observations.wanted.rows()));
}

// In the order of the scene's lights.
void report_lights(const SolveProblem& problem, const Observations& observations, const TracedColumns& traced,
                   const std::vector<Eigen::Array3d>& intensity, SolveResult& result) {
  const LightIntervals intervals = intervals_of(observations, traced, intensity);
  double total = 0;
  for (std::size_t j = 0; j < intensity.size(); ++j) {
    FoundLight& light = result.lights.emplace_back();
    light.light = with_intensity(problem.lights_in_place[j], to_vec3f(intensity[j].matrix()));
    light.contribution = contribution_norm(observations, traced.columns[j], intensity[j]);
    light.intensity_interval = to_vec3f(intervals.lights[j].intensity.matrix());
    total += light.contribution;
  }
  for (FoundLight& light : result.lights) light.contribution /= std::max(total, 1e-300);
  for (const auto& [j, k] : intervals.confounded) result.not_told_apart.emplace_back(int(j) + 1, int(k) + 1);
}

renderer::Lights found_lights(const SolveResult& result) {
  renderer::Lights lights;
  for (const FoundLight& found : result.lights) lights.push_back(found.light);
  return lights;
}

struct ManyObservations {
  std::vector<renderer::SurfaceSample> samples;
  Observations observations;
};

ManyObservations observe_many(const SolveProblem& problem, const SolveOptions& options,
                              const renderer::Control& control) {
  const ReceiverDraw draw = draw_with_the_lit(problem.target, kMany);
  ManyObservations many{numerics::chosen_from(problem.target.receivers.samples, draw.chosen), {}};
  const int fixed_samples = verification_samples(options, many.samples.size());
  const auto fixed = fixed_illumination(problem, many.samples, fixed_samples, options, control);
  many.observations =
      weighted_by_objective(standing_for_all(observe_target(problem.target, draw, fixed)), options.objective);
  many.observations.rules = problem.intensities;
  return many;
}

}  // namespace

std::vector<Eigen::Array3d> refit_over_many(const SolveProblem& problem, const renderer::Lights& lights,
                                            const SolveOptions& options, const renderer::Control& control) {
  const auto [samples, observations] = observe_many(problem, options, control);
  const int paths = std::clamp(int(kComparedPaths / double(samples.size())), kLeastComparedSamples, kLeastSamples);
  const auto [columns, again] = trace_columns(problem, lights, samples, paths, options, control);
  return fit_traced_columns(observations, columns, again).intensity;
}

SolveResult fit_in_place(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control) {
  StageClock clock(options.time_limit);
  SolveResult result;
  check_lights_in_place(problem);
  const auto [samples, observations] = observe_many(problem, options, control);
  const int paths = std::max(kLeastSamples, verification_samples(options, samples.size()));
  const TracedColumns traced_columns =
      trace_columns(problem, problem.lights_in_place, samples, paths, options, control);
  const std::vector<Column>& columns = traced_columns.columns;
  result.cache_seconds = clock.finish_transport("traced_lights", {{"lights", double(columns.size())}});
  const IntensityFit fit = fit_traced_columns(observations, columns, traced_columns.again);
  result.relative_l2_cached = error_of(observations, columns, fit.intensity);
  result.optimal_seconds =
      clock.finish("nnls", {{"relative_l2", result.relative_l2_cached}, {"kkt_residual", fit.kkt_residual}});
  if (std::none_of(fit.intensity.begin(), fit.intensity.end(), [](const auto& l) { return (l > 0).any(); })) {
    const bool reach =
        std::any_of(columns.begin(), columns.end(), [](const Column& c) { return (c.array() > 0).any(); });
    throw renderer::Error(
        {problem.tracer.scene().path, "solve",
         reach ? "no light possible: none of the scene's lights brings what shines already closer to the target"
               : "no light possible: none of the scene's lights brightens the painted surfaces",
         "a target that they can produce, or lights that may move"});
  }
  for (const Eigen::Array3d& intensity : fit.intensity) check_brightness(problem, intensity.maxCoeff());
  std::vector<Eigen::Array3d> before;
  for (const renderer::Light& light : problem.lights_in_place) before.push_back(to_eigen(intensity_of(light)).array());
  result.initial_relative_l2 = error_of(observations, columns, before);
  report_lights(problem, observations, traced_columns, fit.intensity, result);
  result.target_noise = target_noise(problem.target);
  result.important_vertices = int(observations.wanted.rows());
  FreshTrace traced = trace_for_verification(problem, found_lights(result), options, control, clock);
  result.termination = traced.cut_short || clock.out_of_time() ? Termination::kTimeLimit : Termination::kAllStay;
  const int fresh_samples = traced.samples;
  judge(problem, options, std::move(traced), result);
  clock.finish("verification", {{"samples", double(fresh_samples)},
                                {"relative_l2", result.relative_l2},
                                {"relative_standard_error", result.verification_noise.value_or(kNotKnown)}});
  result.stages = clock.stages();
  result.total_seconds = clock.total();
  return result;
}

}  // namespace chiaro::inverse
