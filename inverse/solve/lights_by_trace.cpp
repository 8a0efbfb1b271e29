#include "inverse/solve/lights_by_trace.h"

#include <algorithm>

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/error_curve.h"
#include "inverse/solve/fill_up_lights.h"
#include "inverse/solve/fit_traced_columns.h"
#include "inverse/solve/observe_target.h"
#include "inverse/solve/optimize_jointly.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kMany = 50000;  // receivers at most
constexpr int kLeastPaths = 16;       // of each receiver, traced again …
constexpr double kPathsAgain = 5e6;   // … of all together
constexpr double kDarkest = 1e-20;    // candela: a channel that shines

// Of each channel: by what its light grows. One that does not shine stays dark.
Eigen::Array3d growth(const Eigen::Array3d& before, const Eigen::Array3d& after) {
  return (before > kDarkest).select(after / before.max(kDarkest), 0);
}

Column at_one_candela(const Column& brought, const LightEstimate& light) {
  return brought * growth(light.intensity, Eigen::Array3d::Ones()).matrix().asDiagonal();
}

// A channel of one of them shines that was dark: nothing was traced of it.
bool any_comes_on(const LightEstimates& before, const LightEstimates& after) {
  for (std::size_t j = 0; j < after.size(); ++j) {
    if ((before[j].intensity <= kDarkest && after[j].intensity > kDarkest).any()) return true;
  }
  return false;
}

// Paths of each of so many receivers that are traced again, after a trace of all.
int paths_again(const FreshTrace& traced, std::size_t receivers) {
  return std::min(traced.samples, std::max(kLeastPaths, int(kPathsAgain / double(receivers))));
}

// Unity columns of some receivers, by other paths than those of a trace for verification.
std::vector<Column> traced_again(const SolveProblem& problem, const renderer::TraceOptions& trace,
                                 const renderer::Control& control, const LightEstimates& lights,
                                 const std::vector<std::size_t>& receivers) {
  const auto samples = numerics::chosen_from(problem.target.receivers.samples, receivers);
  const auto traced = trace_illumination_by_light(problem.tracer, samples, point_lights(lights), trace, control);
  std::vector<Column> unity;
  for (std::size_t j = 0; j < lights.size(); ++j)
    unity.push_back(at_one_candela(column_of(traced.of_light[j]), lights[j]));
  return unity;
}

// The trace becomes that of lights that grew so, and its noise as much more or less as its light.
void follow(const std::vector<Eigen::Array3d>& grown, FreshTrace& traced) {
  const std::vector<Vec3f> before = traced.all.value;
  for (std::size_t j = 0; j < grown.size(); ++j) {
    const Vec3f change = to_vec3f((grown[j] - 1).matrix());
    for (std::size_t i = 0; i < traced.all.value.size(); ++i) traced.all.value[i] += change * traced.of_light[j][i];
  }
  for (Vec3f& value : traced.all.value) value = max(value, Vec3f{});  // what was taken off may be more, by rounding
  for (std::size_t i = 0; i < traced.all.standard_error.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (before[i][c] > 0) traced.all.standard_error[i][c] *= traced.all.value[i][c] / before[i][c];
    }
  }
}

// As many lights: where they may share places the trace remains what it is.
LightsByTrace with_none_dark(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                             LightsByTrace by_trace, StageClock& clock) {
  const std::size_t count = by_trace.lights.size();
  if (!may_share_places(problem)) {
    light_the_dark(by_trace.lights);
    LightsByTrace lit = trace_lights(problem, options, control, by_trace.lights, clock);
    lit.settling_seconds = by_trace.settling_seconds;
    return lit;
  }
  LightEstimates lit = as_many_as_asked_for(by_trace.lights, count);
  if (lit.size() == count) by_trace.lights = std::move(lit);
  return by_trace;
}

}  // namespace

StageFigures verification_figures(const FreshTrace& traced, const Target& target) {
  return {{"samples", double(traced.samples)},
          {"relative_standard_error", noise_of(traced, target).value_or(kNotKnown)}};
}

LightsByTrace trace_lights(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                           const LightEstimates& lights, StageClock& clock, std::optional<FreshTrace> first_part) {
  const renderer::Lights all = point_lights(lights);
  LightsByTrace by_trace{lights, first_part ? completed(problem, all, std::move(*first_part), options, control, clock)
                                            : trace_for_verification(problem, all, options, control, clock)};
  clock.finish("verification", verification_figures(by_trace.traced, problem.target));
  return by_trace;
}

LightsByTrace refit_by_trace(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                             const LightEstimates& lights, StageClock& clock) {
  LightsByTrace by_trace = trace_lights(problem, options, control, lights, clock);
  const ReceiverDraw draw = draw_with_the_lit(problem.target, kMany);
  Observations observations =
      observe_target(problem.target, draw, numerics::chosen_from(by_trace.traced.all.value, draw.chosen));
  std::vector<Column> unity;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const Column brought = column_of(numerics::chosen_from(by_trace.traced.of_light[j], draw.chosen));
    observations.wanted += brought;
    unity.push_back(at_one_candela(brought, lights[j]));
  }
  observations = weighted_by_objective(standing_for_all(observations), options.objective);
  observations.rules = problem.intensities;
  const renderer::TraceOptions again{paths_again(by_trace.traced, draw.chosen.size()), problem.bake.bounces,
                                     fresh_seed(options.seed, 7), false};
  const IntensityFit fit =
      fit_traced_columns(observations, unity, traced_again(problem, again, control, lights, draw.chosen));
  for (std::size_t j = 0; j < lights.size(); ++j) by_trace.lights[j] = {lights[j].position, fit.intensity[j]};
  put_out_residue(by_trace.lights);
  std::vector<Eigen::Array3d> grown;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    grown.push_back(growth(lights[j].intensity, by_trace.lights[j].intensity));
  }
  follow(grown, by_trace.traced);
  by_trace.settling_seconds = clock.finish(
      "intensities", {{"relative_l2", relative_error(observations, total_illumination(unity, fit.intensity,
                                                                                      observations.wanted.rows()))}});
  if (any_comes_on(lights, by_trace.lights)) {
    by_trace.traced = trace_lights(problem, options, control, by_trace.lights, clock).traced;
  }
  if (options.exact_lights > 0 && std::any_of(by_trace.lights.begin(), by_trace.lights.end(), is_dark))
    return with_none_dark(problem, options, control, std::move(by_trace), clock);
  return by_trace;
}

}  // namespace chiaro::inverse
