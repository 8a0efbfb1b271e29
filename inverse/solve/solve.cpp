#include "inverse/solve/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/check_brightness.h"
#include "inverse/solve/choose_light_count.h"
#include "inverse/solve/enough_lights.h"
#include "inverse/solve/error_curve.h"
#include "inverse/solve/fit_in_place.h"
#include "inverse/solve/free_light_names.h"
#include "inverse/solve/light_intervals.h"
#include "inverse/solve/not_reached.h"
#include "inverse/solve/observe_target.h"
#include "inverse/solve/prepare_transport.h"
#include "inverse/solve/region_search.h"
#include "inverse/solve/report.h"
#include "inverse/solve/settle_by_trace.h"
#include "inverse/solve/stage_clock.h"
#include "inverse/solve/traced_light.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using renderer::Error;

constexpr int kMostRegions = 7;                 // one larger than the other
constexpr float kHardlySeen = 1.0F / 16;        // of a region's longest side
constexpr double kUnlit = 1e-6;                 // of the target's squared illumination
constexpr std::size_t kMoreVertices = 3;        // times as many, where they misled the search
constexpr double kOnSurface = 0.5;              // of a target's receivers must lie on the scene
constexpr std::size_t kReceiversPerLight = 40;  // at least, for a trace to tell where lights are and to judge them
constexpr double kAsGoodAsDark = 1e-4;          // of all lights: what float rounding may ask for
constexpr double kLights = 0.05;  // of what 1 cd gives as far away as the scene is large, at receivers on average

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

[[noreturn]] void no_light_possible(const SolveProblem& problem, const std::string& why) {
  throw Error({problem.tracer.scene().path, "solve", "no light possible: " + why,
               "a target that lights inside the region can produce"});
}

[[noreturn]] void nothing_lit(const SolveProblem& problem) {
  no_light_possible(problem, fmt::format("no position {}{} lights the painted surfaces",
                                         where_lights_may_stand(problem.places), so_far_from_surfaces(problem.places)));
}

[[noreturn]] void none_brings_closer(const SolveProblem& problem) {
  if (problem.intensities.any()) {
    throw Error(
        {problem.tracer.scene().path, "solve",
         "no light possible: none that keeps to the constraints brings what shines already closer to the target",
         "other limits of intensity or colour, or another target"});
  }
  no_light_possible(problem, problem.kept_lights.empty()
                                 ? "none brings what shines already closer to the target"
                                 : "none brings the lights that stay lit closer to the target than they are alone");
}

// They light nothing that is painted where they stand, or had better not.
[[noreturn]] void all_dark(const SolveProblem& problem, const LightResponse& response, const LightEstimates& found) {
  const double diagonal = double(problem.tracer.bounds().diagonal()), at_diagonal = kLights / (diagonal * diagonal);
  for (const Column& column : evaluate_columns(response, found, Evaluation::kTracedVisibility)) {
    if (column.mean() < at_diagonal) continue;
    none_brings_closer(problem);
  }
  nothing_lit(problem);
}

// Into the result, brightest contribution first. One that the last descent left dark, or as good as, is none, unless so
// many were asked for. Returns those that are reported, in the order of the trace.
LightEstimates report_lights(const SolveProblem& problem, const SolveOptions& options, const RegionSearch& searched,
                             const LightsByTrace& by_trace, SolveResult& result) {
  const LightResponse& response = searched.response;
  const Observations& observations = searched.reported;
  const LightEstimates& lights = by_trace.lights;
  const LightIntervals intervals =
      by_trace.intervals ? *by_trace.intervals : light_intervals(response, observations, lights);
  const std::vector<Column> columns = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
  std::vector<double> norm;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    norm.push_back(contribution_norm(observations, columns[j], lights[j].intensity));
  }
  const double total = std::accumulate(norm.begin(), norm.end(), 0.0);
  if (!(total > 0)) all_dark(problem, response, lights);
  std::vector<std::size_t> order = all_indices(lights.size());
  if (options.exact_lights == 0) {
    std::erase_if(order, [&](std::size_t j) { return is_dark(lights[j]) || norm[j] < kAsGoodAsDark * total; });
  }
  LightEstimates reported = numerics::chosen_from(lights, order);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return norm[a] > norm[b]; });
  const std::vector<std::string> names = free_light_names(problem, order.size());
  std::vector<int> number(lights.size());
  for (const std::size_t j : order) {
    renderer::PointLight light = point_light(lights[j]);
    light.name = names[result.lights.size()];
    number[j] = int(result.lights.size()) + 1;
    result.lights.push_back({light, norm[j] / total, to_vec3f(intervals.lights[j].position),
                             to_vec3f(intervals.lights[j].intensity.matrix())});
  }
  for (const auto& [j, k] : intervals.confounded) {
    if (number[j] > 0 && number[k] > 0) result.not_told_apart.push_back(std::minmax(number[j], number[k]));
  }
  return reported;
}

void check_earlier(const SolveProblem& problem, const SolveOptions& options) {
  if (options.earlier.empty() || !earlier_sets(options).empty()) return;
  std::vector<std::size_t> counts;
  for (const LightSet& set : options.earlier) counts.push_back(set.lights.size());
  throw Error({options.earlier_file.empty() ? problem.tracer.scene().path : options.earlier_file.string(),
               "error_curve", fmt::format("has no set of {} lights", most_lights(options)),
               fmt::format("one of {}", fmt::join(counts, ", "))});
}

[[noreturn]] void too_crowded(const SolveProblem& problem, int lights) {
  const double distance = problem.places.light_distance;
  throw Error({problem.tracer.scene().path, "solve",
               lights > 1 ? fmt::format("no light possible: {} lights {} m apart find no place", lights, distance)
                          : fmt::format("no light possible: none finds a place {} m from those that stay", distance),
               "fewer lights, a smaller distance between them, or a larger region"});
}

// As many as asked for, and one of them shines.
void require_all_lights(const SolveProblem& problem, const SolveOptions& options, const LightResponse& response,
                        const LightEstimates& found) {
  const int wanted = std::max(1, options.exact_lights);
  if (int(found.size()) < wanted) too_crowded(problem, wanted);
  if (std::all_of(found.begin(), found.end(), is_dark)) all_dark(problem, response, found);
}

double brightest_of(const LightEstimates& lights) {
  double brightest = 0;
  for (const LightEstimate& light : lights) brightest = std::max(brightest, light.intensity.maxCoeff());
  return brightest;
}

// Where what they leave is no noise: the fewest whose error further ones do not lower clearly.
LightEstimates at_knee(const Optimum& found, const SolveOptions& options) {
  double least = std::numeric_limits<double>::infinity();
  for (const LightSet& set : found.error_curve) least = std::min(least, set.relative_l2);
  const auto enough = [&](const LightSet& set) { return set.relative_l2 <= kKnee * least; };
  const auto fewest = std::find_if(found.error_curve.begin(), found.error_curve.end(), enough);
  const bool may_be_fewer = options.exact_lights == 0 && found.held == 0 && fewest != found.error_curve.end();
  return may_be_fewer && fewest->lights.size() < found.lights.size() ? light_estimates(fewest->lights) : found.lights;
}

// Lights fitted to so few would leave nothing of the noise of the trace that they are judged by.
bool would_be_fitted_to_noise(const Target& target, std::size_t lights) {
  const auto weighed = std::count_if(target.weight.begin(), target.weight.end(), [](float w) { return w > 0; });
  return std::size_t(weighed) < kReceiversPerLight * lights;
}

LightsByTrace traced(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                     const LightResponse& response, const Optimum& found, StageClock& clock) {
  if (clock.out_of_time() || would_be_fitted_to_noise(problem.target, found.lights.size())) {
    return trace_lights(problem, options, control, found.lights, clock);
  }
  if (found.settles) {
    LightsByTrace settled = settle_by_trace(problem, options, control, response, found, clock);
    if (!settled.went_astray || clock.out_of_time()) return settled;
    return refit_by_trace(problem, options, control, at_knee(found, options), clock);
  }
  if (found.refits) return refit_by_trace(problem, options, control, found.lights, clock);
  return trace_lights(problem, options, control, found.lights, clock);
}

// Lights that settle may be fewer than the search came to.
Termination termination_of(const Optimum& searched, std::size_t lights) {
  const bool fewer = lights < searched.lights.size();
  return fewer && searched.termination == Termination::kAsManyAsAllowed ? Termination::kNoFurtherExplainsMore
                                                                        : searched.termination;
}

// Nobody says where the region of the lights ends, nor has a cache one of its own.
bool region_may_grow(const SolveProblem& problem) {
  if (problem.grid.region) return false;
  if (!problem.cache_file) return true;
  return load_transport_cache_header(*problem.cache_file).grid.region == default_region(problem.tracer);
}

// The brightest receivers, which hold all that counts of the target.
std::vector<std::size_t> lit_receivers(const Target& target) {
  std::vector<double> energy;
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    energy.push_back(double(target.weight[i]) * squared_norm(target.illumination[i]));
  }
  std::vector<std::size_t> brightest = all_indices(energy.size());
  std::sort(brightest.begin(), brightest.end(), [&](std::size_t a, std::size_t b) { return energy[a] > energy[b]; });
  double left = std::accumulate(energy.begin(), energy.end(), 0.0);
  const double unlit = kUnlit * left;
  std::size_t count = 0;
  while (count < brightest.size() && left > unlit) left -= energy[brightest[count++]];
  brightest.resize(count);
  return brightest;
}

// Of what is lit, where a grid of the whole scene would hardly have a light. Absent: it has, or what is lit is hardly a
// surface.
std::optional<Box3f> surroundings(const SolveProblem& problem) {
  const std::vector<std::size_t> lit = lit_receivers(problem.target);
  if (lit.size() < kReceiversPerLight) return std::nullopt;
  Box3f box;
  for (const std::size_t i : lit) box.extend(problem.target.receivers.samples[i].position);
  const float diagonal = box.diagonal(), longest = max_component(default_region(problem.tracer).extent());
  const Vec3f around{diagonal, diagonal, diagonal};
  const Box3f region{box.min - around, box.max + around};
  return max_component(region.extent()) < kHardlySeen * longest ? std::optional(region) : std::nullopt;
}

// Where lights of an earlier solve stand it reaches, too. Absent: as the problem says.
std::optional<Box3f> first_region(const SolveProblem& problem, const SolveOptions& options) {
  if (!region_may_grow(problem)) return std::nullopt;
  const std::optional<Box3f> around = surroundings(problem);
  if (options.earlier.empty()) return around;
  const Box3f before = around.value_or(default_region(problem.tracer));
  Box3f region = before;
  for (const LightSet& set : options.earlier) {
    for (const renderer::PointLight& light : set.lights) region.extend(light.position);
  }
  return region == before ? around : region;
}

SearchBasis make_basis(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                       Importance importance) {
  auto samples = numerics::chosen_from(problem.target.receivers.samples, importance.chosen);
  const std::vector<Vec3f> fixed = fixed_illumination(problem, samples, kFixedSamples, options, control);
  Observations published = observe_target(problem.target, {importance.chosen, importance.probability}, fixed);
  published = with_noise(std::move(published), problem.target, importance.chosen);
  return {options,
          control,
          std::move(importance),
          std::move(samples),
          std::move(published),
          region_may_grow(problem) && options.earlier.empty()};
}

// Null: `fallback` is what there is, as the grid of another region has too many lights, or none.
std::unique_ptr<RegionSearch> search_region(const std::shared_ptr<const SearchBasis>& basis,
                                            const SolveProblem& problem, const std::optional<Box3f>& region,
                                            const RegionSearch* fallback, const RegionSearch* before,
                                            StageClock& clock) {
  try {
    return std::make_unique<RegionSearch>(basis, problem, region, before, clock);
  } catch (const NoUsableGrid&) {
    if (fallback == nullptr) throw;
    return nullptr;
  }
}

void add_seconds_of(const RegionSearch& search, SolveResult& result) {
  result.initial_seconds += search.initial_seconds;
  result.optimal_seconds += search.optimal_seconds;
  result.cache_seconds += search.cache_seconds;
}

// In ever larger regions, as long as that brings the lights clearly closer. before: with other important vertices.
std::unique_ptr<RegionSearch> search(const std::shared_ptr<const SearchBasis>& basis, const SolveProblem& problem,
                                     std::optional<Box3f> region, const RegionSearch* before, StageClock& clock,
                                     SolveResult& result) {
  std::unique_ptr<RegionSearch> best;
  for (int regions = 0; regions < kMostRegions && (!best || (region && !clock.out_of_time())); ++regions) {
    auto search = search_region(basis, problem, region, best.get(), best ? best.get() : before, clock);
    if (!search) break;
    add_seconds_of(*search, result);
    if (best && !search->is_clearly_better_than(*best)) return best;
    best = std::move(search);
    region = best->wider_region();
    result.optimal_seconds += clock.finish("region", {{"grows", region ? 1 : 0}});
  }
  best->lights_may_be_farther = region.has_value();
  return best;
}

// By so many important vertices, or more where these misled it, or where lights are many.
std::unique_ptr<RegionSearch> search(const SolveProblem& problem, const SolveOptions& options,
                                     const renderer::Control& control, StageClock& clock, SolveResult& result) {
  const std::uint64_t seed = fresh_seed(options.seed, 3);
  const auto basis_of = [&](Importance importance) {
    result.initial_seconds += clock.finish("important_vertices", {{"count", double(importance.chosen.size())}});
    auto basis = std::make_shared<const SearchBasis>(make_basis(problem, options, control, std::move(importance)));
    clock.finish_transport("fixed_illumination", {});
    return basis;
  };
  const auto basis = basis_of(choose_important_vertices(
      problem.tracer, problem.target,
      {options.important_vertices, options.geometry_weight, options.illumination_weight, seed}));
  if (!(basis->published.wanted.array() > 0).any())
    no_light_possible(problem, "the target is nowhere brighter than what shines already");
  std::optional<Box3f> first = first_region(problem, options);
  std::unique_ptr<RegionSearch> found;
  try {
    found = search(basis, problem, first, nullptr, clock, result);
  } catch (const NoUsableGrid&) {
    if (!first) throw;
    first.reset();  // lights may stand nowhere around what is lit
    found = search(basis, problem, first, nullptr, clock, result);
  }
  if (first && options.earlier.empty() && !found->comes_close() && !clock.out_of_time()) {
    auto everywhere = search_region(basis, problem, std::nullopt, found.get(), found.get(), clock);
    if (everywhere) add_seconds_of(*everywhere, result);
    if (everywhere && everywhere->is_clearly_better_than(*found)) found = std::move(everywhere);
  }
  if (!(found->was_misled() || found->has_many()) || clock.out_of_time()) return found;

  const std::size_t before = basis->importance.chosen.size();
  Importance more = choose_again(basis->importance, problem.target, kMoreVertices * before, seed);
  if (more.chosen.size() == before) return found;
  auto again = search(basis_of(std::move(more)), problem, found->problem.grid.region, found.get(), clock, result);
  again->lights_may_be_farther = again->lights_may_be_farther || found->lights_may_be_farther;
  const bool goes_on = found->has_many() && !clock.out_of_time();
  return goes_on || again->misses_less_than(*found) ? std::move(again) : std::move(found);
}

}  // namespace

SolveResult solve(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control) {
  StageClock clock(options.time_limit);
  SolveResult result;
  check_target(problem);
  check_earlier(problem, options);
  if (!problem.lights_in_place.empty()) {
    require_fitting_cache(problem);
    return fit_in_place(problem, options, control);
  }
  require_free_space(problem, control);

  const std::unique_ptr<RegionSearch> searched = search(problem, options, control, clock, result);
  if (options.exact_lights == 0 && !searched->brings_closer()) none_brings_closer(problem);
  const Importance& importance = searched->basis->importance;
  result.important_vertices = int(importance.chosen.size());
  const double before = clock.total();
  Optimum optimum = searched->conclude(clock);
  if (fill_up_to_wanted(problem, options, *searched, {clock, control}, optimum)) {
    clock.finish("filling_up", {{"lights", double(optimum.lights.size())}});
  }
  result.optimal_seconds += clock.total() - before;
  require_all_lights(problem, options, searched->response, optimum.lights);
  check_brightness(problem, brightest_of(optimum.lights));
  LightsByTrace by_trace = traced(problem, options, control, searched->response, optimum, clock);
  check_brightness(problem, brightest_of(by_trace.lights));
  result.optimal_seconds += by_trace.settling_seconds;
  const LightEstimates lights = report_lights(problem, options, *searched, by_trace, result);
  result.initial_relative_l2 = relative_error(searched->reported, illumination_of(searched->response, optimum.start));
  result.relative_l2_cached = relative_error(searched->reported, illumination_of(searched->response, lights));
  result.termination = by_trace.traced.cut_short || clock.out_of_time() ? Termination::kTimeLimit
                                                                        : termination_of(optimum, lights.size());
  result.error_curve = optimum.error_curve;
  if (options.method == SolveMethod::kJoint) {
    // Those that have settled fit the important vertices less closely, and the target more, than those of the search.
    const double error = searched->error_in_curve(lights, optimum.curve_by_held_out);
    put_in_curve(set_of(lights, error), result.error_curve);
    complete_curve(problem, *searched, {clock, control}, optimum.curve_by_held_out, result.error_curve);
  }
  result.region = searched->transport.cache.grid.region;
  result.lights_may_be_farther = searched->lights_may_be_farther;
  result.target_noise = target_noise(problem.target);
  judge(problem, options, std::move(by_trace.traced), result);
  leave_unknown_beyond_region(result);
  leave_unknown_at_border(problem, result);
  result.stages = clock.stages();
  if (options.keep_stages) {
    result.found_by_stages =
        std::make_shared<SolveStages>(SolveStages{importance, searched->transport.cache.grid, searched->distribution,
                                                  searched->clusters, searched->tree, optimum.cut, lights});
  }
  result.total_seconds = clock.total();
  return result;
}

}  // namespace chiaro::inverse
