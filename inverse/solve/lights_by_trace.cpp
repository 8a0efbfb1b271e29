#include "inverse/solve/lights_by_trace.h"

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/fill_up_lights.h"
#include "inverse/solve/observe_target.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kMany = 50000;  // receivers at most
constexpr double kDarkest = 1e-20;    // candela: a channel that shines

// Of each channel: by what its light grows. One that does not shine stays dark.
Eigen::Array3d growth(const Eigen::Array3d& before, const Eigen::Array3d& after) {
  return (before > kDarkest).select(after / before.max(kDarkest), 0);
}

// The trace becomes that of lights that grew so.
void follow(const std::vector<Eigen::Array3d>& grown, FreshTrace& traced) {
  for (std::size_t j = 0; j < grown.size(); ++j) {
    const Vec3f change = to_vec3f((grown[j] - 1).matrix());
    for (std::size_t i = 0; i < traced.all.value.size(); ++i) traced.all.value[i] += change * traced.of_light[j][i];
  }
  for (Vec3f& value : traced.all.value) value = max(value, Vec3f{});  // what was taken off may be more, by rounding
}

}  // namespace

StageFigures verification_figures(const FreshTrace& traced) {
  return {{"samples", double(traced.samples)},
          {"relative_standard_error", relative_standard_error(traced.all).value_or(kNotKnown)}};
}

LightsByTrace trace_lights(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                           const LightEstimates& lights, StageClock& clock, std::optional<FreshTrace> first_part) {
  const renderer::Lights all = point_lights(lights);
  LightsByTrace by_trace{lights, first_part ? completed(problem, all, std::move(*first_part), options, control, clock)
                                            : trace_for_verification(problem, all, options, control, clock)};
  clock.finish("verification", verification_figures(by_trace.traced));
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
    unity.push_back(brought * growth(lights[j].intensity, Eigen::Array3d::Ones()).matrix().asDiagonal());
  }
  observations = weighted_by_objective(standing_for_all(observations), options.objective);
  observations.rules = problem.intensities;
  const IntensityFit fit = fit_intensities(observations, unity);
  for (std::size_t j = 0; j < lights.size(); ++j) by_trace.lights[j] = {lights[j].position, fit.intensity[j]};
  if (options.exact_lights > 0) light_the_dark(by_trace.lights);
  std::vector<Eigen::Array3d> grown;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    grown.push_back(growth(lights[j].intensity, by_trace.lights[j].intensity));
  }
  follow(grown, by_trace.traced);
  by_trace.settling_seconds = clock.finish(
      "intensities", {{"relative_l2", relative_error(observations, total_illumination(unity, fit.intensity,
                                                                                      observations.wanted.rows()))}});
  return by_trace;
}

}  // namespace chiaro::inverse
