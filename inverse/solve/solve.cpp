#include "inverse/solve/solve.h"

#include <fmt/format.h>

#include <memory>
#include <numeric>
#include <optional>

#include "inverse/solve/fill_up_lights.h"
#include "inverse/solve/fit_in_place.h"
#include "inverse/solve/important_vertices.h"
#include "inverse/solve/light_intervals.h"
#include "inverse/solve/lights_beside_surfaces.h"
#include "inverse/solve/observe_target.h"
#include "inverse/solve/optimize_jointly.h"
#include "inverse/solve/optimize_simplex.h"
#include "inverse/solve/prepare_transport.h"
#include "inverse/solve/report.h"
#include "inverse/solve/settle_by_trace.h"
#include "inverse/solve/stage_clock.h"
#include "inverse/solve/traced_light.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using renderer::Error;

constexpr int kFixedSamples = 512;      // per important vertex
constexpr std::size_t kHeldOut = 1500;  // receivers that tell how many lights there are
constexpr double kOnSurface = 0.5;      // of a target's receivers must lie on the scene

void check_target(const SolveProblem& problem) {
  const double fraction = fraction_on_surface(problem.tracer, problem.target.receivers);
  if (fraction >= kOnSurface) return;
  throw Error({problem.tracer.scene().path, "target",
               fmt::format("only {:.0f} % of the target's vertices lie on the scene: it is a target of another scene",
                           100 * fraction),
               "a target on this scene's surfaces"});
}

std::vector<std::size_t> all_indices(std::size_t count) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

std::unique_ptr<HeldOut> hold_out(const SolveProblem& problem, BakeSettings settings, const SolveOptions& options,
                                  const renderer::Control& control) {
  const ReceiverDraw draw = draw_evenly(problem.target, kHeldOut);
  const auto samples = samples_at(problem.target, draw.chosen);
  settings.seed = fresh_seed(options.seed, 5);
  Observations observations =
      observe_target(problem.target, draw, fixed_illumination(problem, samples, kFixedSamples, options, control));
  return std::make_unique<HeldOut>(problem.tracer, samples, std::move(observations), settings);
}

// Brightest contribution first.
void report_lights(const LightResponse& response, const Observations& observations, const LightsByTrace& by_trace,
                   SolveResult& result) {
  const LightEstimates& lights = by_trace.lights;
  const LightIntervals intervals =
      by_trace.intervals ? *by_trace.intervals : light_intervals(response, observations, lights);
  const std::vector<Column> columns = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
  std::vector<double> norm;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    norm.push_back(contribution_norm(observations, columns[j], lights[j].intensity));
  }
  const double total = std::accumulate(norm.begin(), norm.end(), 0.0);
  std::vector<std::size_t> order = all_indices(lights.size());
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return norm[a] > norm[b]; });
  std::vector<int> number(lights.size());
  for (const std::size_t j : order) {
    renderer::PointLight light = point_light(lights[j]);
    number[j] = int(result.lights.size()) + 1;
    light.name = fmt::format("light{}", number[j]);
    result.lights.push_back({light, norm[j] / total, to_vec3f(intervals.lights[j].position),
                             to_vec3f(intervals.lights[j].intensity.matrix())});
  }
  for (const auto& [j, k] : intervals.confounded) result.not_told_apart.push_back(std::minmax(number[j], number[k]));
}

// Sections 3.4.2 and 3.4.3.
Optimum optimize_as_published(const LightResponse& response, const Observations& observations, const LightTree& tree,
                              const SolveOptions& options, StageClock& clock) {
  CutOptions cut_options{options.error_threshold.value_or(kDefaultThesisThreshold), 1, options.max_lights};
  if (options.exact_lights > 0) cut_options = {0, options.exact_lights, options.exact_lights};
  const LightCutResult cut = cut_light_tree(tree, observations, cut_options);
  clock.finish("lightcut", {{"lights", double(cut.lights.size())}, {"relative_l2", cut.error}});
  if (cut.lights.empty()) return {{}, {}, "no light of the grid reaches the painted surfaces", {}};
  const SimplexOptimum optimum = optimize_simplex(response, observations, cut.lights);
  clock.finish("nelder_mead", {{"evaluations", optimum.evaluations}, {"relative_l2", optimum.error}});
  const bool reached = cut.error <= cut_options.error_threshold || options.exact_lights > 0;
  return {optimum.lights, cut.lights, reached ? "error threshold of the lightcut met" : "every cluster is a light",
          cut.nodes};
}

[[noreturn]] void no_light_possible(const SolveProblem& problem, const std::string& why) {
  throw Error({problem.tracer.scene().path, "solve", "no light possible: " + why,
               "a target that lights inside the region can produce"});
}

AllowedPlaces allowed_places(const SolveProblem& problem, const LightGrid& grid) {
  std::vector<Eigen::Vector3d> stay;
  for (const renderer::Light& light : problem.kept_lights) {
    if (const auto* point = std::get_if<renderer::PointLight>(&light)) stay.push_back(to_eigen(point->position));
    if (const auto* spot = std::get_if<renderer::SpotLight>(&light)) stay.push_back(to_eigen(spot->position));
  }
  return {problem.tracer.scene(), grid.region, problem.places, std::move(stay)};
}

std::string where_lights_may_stand(const PlaceRules& rules) {
  std::vector<std::string> nodes;
  for (const Mount& mount : rules.mounts) nodes.push_back('"' + mount.node + '"');
  const std::string hanging = fmt::format("where lights hang on {}", fmt::join(nodes, ", "));
  if (nodes.empty()) return "in the region";
  return rules.boxes.empty() ? hanging : "in the region or " + hanging;
}

std::string so_far_from_surfaces(const PlaceRules& rules) {
  return rules.surface_distance > 0 ? fmt::format(" {} m from all surfaces", rules.surface_distance) : "";
}

[[noreturn]] void no_place(const SolveProblem& problem) {
  throw Error({problem.tracer.scene().path, "solve",
               fmt::format("no light possible: nowhere {} is a place{}", where_lights_may_stand(problem.places),
                           so_far_from_surfaces(problem.places)),
               "a smaller distance to surfaces, or a larger region"});
}

void check_earlier(const SolveProblem& problem, const SolveOptions& options) {
  if (options.earlier.empty() || !earlier_sets(options).empty()) return;
  std::vector<std::size_t> counts;
  for (const LightSet& set : options.earlier) counts.push_back(set.lights.size());
  throw Error(
      {problem.tracer.scene().path, "earlier solve",
       fmt::format("has no set of {} lights", options.exact_lights > 0 ? options.exact_lights : options.max_lights),
       fmt::format("one of {}", fmt::join(counts, ", "))});
}

[[noreturn]] void nothing_lit(const SolveProblem& problem) {
  no_light_possible(problem, fmt::format("no position {}{} lights the painted surfaces",
                                         where_lights_may_stand(problem.places), so_far_from_surfaces(problem.places)));
}

[[noreturn]] void too_crowded(const SolveProblem& problem, int lights) {
  const double distance = problem.places.light_distance;
  throw Error({problem.tracer.scene().path, "solve",
               lights > 1 ? fmt::format("no light possible: {} lights {} m apart find no place", lights, distance)
                          : fmt::format("no light possible: none finds a place {} m from those that stay", distance),
               "fewer lights, a smaller distance between them, or a larger region"});
}

// As many as asked for, and one of them shines.
void require_all_lights(const SolveProblem& problem, const SolveOptions& options, const LightEstimates& found) {
  const int wanted = std::max(1, options.exact_lights);
  if (int(found.size()) < wanted) too_crowded(problem, wanted);
  const auto is_dark = [](const LightEstimate& light) { return !(light.intensity > 0).any(); };
  if (std::all_of(found.begin(), found.end(), is_dark)) nothing_lit(problem);
}

LightsByTrace traced(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                     const LightResponse& response, const Optimum& found, StageClock& clock) {
  if (found.settles) return settle_by_trace(problem, options, control, response, found, clock);
  if (found.refits) return refit_by_trace(problem, options, control, found.lights, clock);
  return trace_lights(problem, options, control, found.lights, clock);
}

}  // namespace

SolveResult solve(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control) {
  StageClock clock;
  SolveResult result;
  check_target(problem);
  check_earlier(problem, options);
  if (!problem.lights_in_place.empty()) return fit_in_place(problem, options, control);

  const Importance importance = choose_important_vertices(
      problem.tracer, problem.target,
      {options.important_vertices, options.geometry_weight, options.illumination_weight, fresh_seed(options.seed, 3)});
  result.important_vertices = int(importance.chosen.size());
  result.initial_seconds += clock.finish("important_vertices", {{"count", double(importance.chosen.size())}});

  const PreparedTransport transport = prepare_transport(problem, importance.chosen, control);
  result.cache_seconds = clock.finish("cache", {{"lights", double(transport.cache.grid.positions.size())},
                                                {"indirect_relative_error", transport.cache.indirect_relative_error}});
  const auto samples = samples_at(problem.target, importance.chosen);
  const std::vector<Vec3f> fixed = fixed_illumination(problem, samples, kFixedSamples, options, control);
  const Observations published = observe_target(problem.target, {importance.chosen, importance.probability}, fixed);
  if (!(published.wanted.array() > 0).any())
    no_light_possible(problem, "the target is nowhere brighter than what shines already");
  const LightResponse response(problem.tracer, samples, transport.cache, allowed_places(problem, transport.cache.grid));
  if (response.grid_lights_near_places().empty()) no_place(problem);
  clock.finish("fixed_illumination", {});

  const bool joint = options.method == SolveMethod::kJoint;
  const Observations reported = joint ? standing_for_all(published) : published;
  Observations judged = joint ? weighted_by_objective(reported, options.objective) : published;
  judged.rules = problem.intensities;
  Observations searched = published;
  std::optional<ExactIndirect> exact;
  std::unique_ptr<HeldOut> held_out;
  LightEstimates beside_surfaces;
  if (joint) {
    exact.emplace(problem.tracer, samples, transport.cache.settings);
    clock.finish("exact_indirect", {});
    if (options.earlier.empty() && !ties_lights_together(problem)) {
      beside_surfaces = find_lights_beside_surfaces(response, *exact, judged, most_lights(options));
    }
    searched = published.noise > 0 ? weighted_by_noise(published, transport.cache.indirect_relative_error)
                                   : with_capped_weights(weighted_by_objective(published, options.objective));
    result.optimal_seconds += clock.finish("lights_beside_surfaces", {{"lights", double(beside_surfaces.size())}});
    if (beside_surfaces.empty()) {
      held_out = hold_out(problem, transport.cache.settings, options, control);
      clock.finish("held_out", {});
    }
  }

  const Observations remaining = less(searched, response, beside_surfaces);
  const LightDistribution distribution = estimate_light_distribution(response, remaining, options.weak_light);
  result.initial_seconds += clock.finish("nnls", distribution_figures(distribution));
  const LightEstimates clusters = segment_distribution(distribution, remaining);
  result.initial_seconds += clock.finish("watershed", {{"clusters", double(clusters.size())}});

  const LightTree tree = make_light_tree(response, remaining, clusters);
  result.optimal_seconds += clock.finish("light_tree", {{"leaves", double(clusters.size())}});
  const double before = clock.total();
  Optimum optimum =
      joint
          ? optimize_jointly({problem, options, control, response, *exact, searched, judged, reported, held_out.get()},
                             beside_surfaces, tree, clock)
          : optimize_as_published(response, published, tree, options, clock);
  result.optimal_seconds += clock.total() - before;

  optimum.lights =
      filled_up(response, judged, std::move(optimum.lights), std::size_t(std::max(1, options.exact_lights)));
  require_all_lights(problem, options, optimum.lights);
  LightsByTrace by_trace = traced(problem, options, control, response, optimum, clock);
  result.optimal_seconds += by_trace.settling_seconds;
  report_lights(response, reported, by_trace, result);
  result.initial_relative_l2 = relative_error(reported, illumination_of(response, optimum.start));
  result.relative_l2_cached = relative_error(reported, illumination_of(response, by_trace.lights));
  result.termination = optimum.termination;
  result.error_curve = optimum.error_curve;
  result.target_noise = target_noise(problem.target);
  judge(problem, options, std::move(by_trace.traced), result);
  result.stages = clock.stages();
  if (!options.report_folder.empty()) {
    write_report({problem.tracer.scene(), problem.target, importance, transport.cache.grid, distribution, clusters,
                  tree, optimum.cut, by_trace.lights, result},
                 options.report_folder);
    clock.finish("report", {});
    result.stages = clock.stages();
  }
  result.total_seconds = clock.total();
  return result;
}

}  // namespace chiaro::inverse
