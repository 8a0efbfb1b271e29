#include "inverse/solve/region_search.h"

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/choose_light_count.h"
#include "inverse/solve/light_from_outside.h"
#include "inverse/solve/lights_beside_surfaces.h"
#include "inverse/solve/observe_target.h"
#include "inverse/solve/optimize_simplex.h"
#include "inverse/solve/polish_lights.h"
#include "inverse/solve/report.h"
#include "inverse/solve/traced_light.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kHeldOut = 6000;  // receivers that tell how many lights there are
constexpr double kCloseEnough = 0.01;   // of what is wanted: error, whatever the noise
constexpr double kMatters = 0.05;       // of what is wanted: a light that a larger region is for
constexpr std::size_t kCrowd = 3;       // so many of them at the border may stand for fewer beyond it
constexpr double kAsClose = 1.1;        // of an error, or less: fewer lights are better
constexpr float kGrowth = 0.5F;         // of the region's longest side
constexpr double kClearlyBetter = 0.9;  // of an error, or less
constexpr double kMisled = 0.1;  // of the target's brightness, that lights miss where they were not fitted to it …
constexpr double kMisledAndFar = 0.05;      // … or that those do that leave more than noise where they were
constexpr std::size_t kMany = 9;            // lights, and more: of so many a thousand receivers see too little …
constexpr double kLittleElse = 5;           // … where they leave so many times the noise at most
constexpr double kFartherElsewhere = 1.05;  // times the error where lights were fitted, or more: that misled them

std::shared_ptr<const HeldOut> hold_out(const SearchBasis& basis, const SolveProblem& problem, BakeSettings settings) {
  const ReceiverDraw draw = draw_with_the_lit(problem.target, kHeldOut);
  const auto samples = numerics::chosen_from(problem.target.receivers.samples, draw.chosen);
  settings.seed = fresh_seed(basis.options.seed, 5);
  const std::vector<Vec3f> fixed = fixed_illumination(problem, samples, kFixedSamples, basis.options, basis.control);
  Observations observations = with_noise(observe_target(problem.target, draw, fixed), problem.target, draw.chosen);
  observations = standing_for_all(observations);
  observations.rules = problem.intensities;
  Observations judged = weighted_by_objective(observations, basis.options.objective);
  return std::make_shared<const HeldOut>(problem.tracer, samples, std::move(observations), std::move(judged), settings,
                                         basis.control);
}

AllowedPlaces allowed_places(const SolveProblem& problem, const LightGrid& grid) {
  std::vector<Vector3d> stay;
  for (const renderer::Light& light : problem.kept_lights) {
    if (const auto* point = std::get_if<renderer::PointLight>(&light)) stay.push_back(to_eigen(point->position));
    if (const auto* spot = std::get_if<renderer::SpotLight>(&light)) stay.push_back(to_eigen(spot->position));
  }
  return {problem.tracer.scene(), grid.region, problem.places, std::move(stay)};
}

// Sections 3.4.2 and 3.4.3.
Optimum optimize_as_published(const LightResponse& response, const Observations& observations, const LightTree& tree,
                              const SolveOptions& options, StageClock& clock, const renderer::Control& control) {
  CutOptions cut_options{options.error_threshold.value_or(kDefaultThesisThreshold), 1, options.max_lights};
  if (options.exact_lights > 0) cut_options = {0, options.exact_lights, options.exact_lights};
  const LightCutResult cut = cut_light_tree(tree, observations, cut_options);
  clock.finish("lightcut", {{"lights", double(cut.lights.size())}, {"relative_l2", cut.error}});
  if (cut.lights.empty()) return {{}, {}, Termination::kNoneReaches, {}};
  const SimplexOptimum optimum = optimize_simplex(response, observations, cut.lights,
                                                  [&] { return clock.out_of_time() || control.stop_requested(); });
  control.stop_if_requested();
  clock.finish("nelder_mead", {{"evaluations", optimum.evaluations}, {"relative_l2", optimum.error}});
  return {optimum.lights, cut.lights,
          clock.out_of_time()                            ? Termination::kTimeLimit
          : options.exact_lights > 0                     ? Termination::kAsManyAsAskedFor
          : cut.error <= cut_options.error_threshold     ? Termination::kThresholdMet
          : int(cut.lights.size()) == options.max_lights ? Termination::kAsManyAsAllowed
                                                         : Termination::kEveryCluster,
          cut.nodes};
}

bool is_joint(const SearchBasis& basis) { return basis.options.method == SolveMethod::kJoint; }

// Of what shines already nothing is left in it.
double norm_of_wanted(const Observations& observations) {
  return std::max((observations.sqrt_weight.asDiagonal() * observations.wanted).norm(), 1e-300);
}

// The faces of a region that one of the lights is at, or beyond, moved outwards.
struct Growth {
  Box3f region;
  std::size_t lights_at_border = 0;
};

Growth grown_at(const Box3f& region, const std::vector<Vector3d>& lights) {
  const float near = float(kAtBorder) * region.diagonal(), by = kGrowth * max_component(region.extent());
  Growth growth{region};
  for (const Vector3d& light : lights) {
    const Vec3f at = to_vec3f(light);
    bool at_border = false;
    for (int a = 0; a < 3; ++a) {
      if (at[a] - region.min[a] <= near) growth.region.min[a] = region.min[a] - by, at_border = true;
      if (region.max[a] - at[a] <= near) growth.region.max[a] = region.max[a] + by, at_border = true;
    }
    growth.lights_at_border += at_border ? 1 : 0;
  }
  return growth;
}

// Another region than a cache's is baked here.
SolveProblem with_region(SolveProblem problem, const std::optional<Box3f>& region) {
  if (!region) return problem;
  if (problem.grid.region != region) problem.cache_file.reset();
  problem.grid.region = region;
  return problem;
}

}  // namespace

RegionSearch::RegionSearch(std::shared_ptr<const SearchBasis> basis_, const SolveProblem& problem_,
                           const std::optional<Box3f>& region, const RegionSearch* before, StageClock& clock)
    : basis(std::move(basis_)),
      problem(with_region(problem_, region)),
      transport(prepare_transport(problem, basis->importance.chosen, basis->control)),
      response(problem.tracer, basis->samples, transport.cache, allowed_places(problem, transport.cache.grid)) {
  if (response.grid_lights_near_places().empty()) throw no_place(problem.tracer.scene(), problem.places);
  cache_seconds =
      clock.finish_transport("cache", {{"lights", double(transport.cache.grid.positions.size())},
                                       {"indirect_relative_error", transport.cache.indirect_relative_error}});
  reported = is_joint(*basis) ? standing_for_all(basis->published) : basis->published;
  judged = is_joint(*basis) ? weighted_by_objective(reported, basis->options.objective) : basis->published;
  judged.rules = problem.intensities;
  searched_ = basis->published;
  const bool goes_on = before != nullptr && before->basis != basis && before->has_many();
  if (is_joint(*basis)) look_beside_surfaces(before, goes_on, clock);
  if (goes_on) {
    distribution = before->distribution;
    clusters = before->clusters;
    tree = before->tree;
  } else {
    look_where_light_comes_from(clock);
  }
  if (!is_joint(*basis)) return;
  JointSearch search = joint_search();
  if (goes_on) search.begun = &before->found_;
  const double begun = clock.total();
  found_ = search_jointly(search, beside_surfaces_, tree, clock);
  optimal_seconds += clock.total() - begun;
  see_how_far_held_out_ones_are(before, clock);
}

void RegionSearch::look_where_light_comes_from(StageClock& clock) {
  const Observations remaining = less(searched_, response, beside_surfaces_);
  distribution = estimate_light_distribution(response, remaining, basis->options.weak_light);
  initial_seconds += clock.finish("nnls", distribution_figures(distribution));
  clusters = segment_distribution(distribution, remaining);
  initial_seconds += clock.finish("watershed", {{"clusters", double(clusters.size())}});
  tree = make_light_tree(response, remaining, clusters);
  optimal_seconds += clock.finish("light_tree", {{"leaves", double(clusters.size())}});
}

void RegionSearch::look_beside_surfaces(const RegionSearch* before, bool goes_on, StageClock& clock) {
  const TransportCache& cache = transport.cache;
  const bool same_vertices = before != nullptr && before->basis == basis;
  BakeSettings settings = cache.settings;
  settings.seed = fresh_seed(basis->options.seed, 9);
  exact_ = same_vertices
               ? before->exact_
               : std::make_shared<const ExactIndirect>(problem.tracer, basis->samples, settings, basis->control);
  clock.finish_transport("exact_indirect", {});
  if (!goes_on && basis->options.earlier.empty() && !ties_lights_together(problem) && !clock.out_of_time()) {
    beside_surfaces_ = find_lights_beside_surfaces(response, *exact_, judged, most_lights(basis->options));
  }
  searched_ = basis->published.noise > 0
                  ? weighted_by_noise(basis->published, cache.indirect_relative_error)
                  : with_capped_weights(weighted_by_objective(basis->published, basis->options.objective));
  optimal_seconds += clock.finish("lights_beside_surfaces", {{"lights", double(beside_surfaces_.size())}});
  // Without noise a fit errs by transport alone, and so do those that are held out.
  if (!beside_surfaces_.empty() || basis->published.noise == 0 || clock.out_of_time()) return;
  share_or_hold_out(before, clock);
}

// Without noise they do not tell how many lights there are, but what a fit to others is worth; and so they do of
// another search that is to be compared with one that they speak of.
void RegionSearch::see_how_far_held_out_ones_are(const RegionSearch* before, StageClock& clock) {
  const bool compared = before != nullptr && before->found_.held_out.size() > 0;
  const bool tells = basis->published.noise == 0 && found_.beside_surfaces.empty() && part_left() > kCloseEnough;
  const bool known = found_.held_out.size() > 0 || !(compared || tells);
  if (known || found_.out_of_time || clock.out_of_time()) return;
  share_or_hold_out(before, clock);
  found_.held_out = HeldOutSets(*held_out_, 0).residuals(all_of(found_));
}

void RegionSearch::share_or_hold_out(const RegionSearch* before, StageClock& clock) {
  const bool there = before != nullptr && before->held_out_;
  held_out_ = there ? before->held_out_ : hold_out(*basis, problem, transport.cache.settings);
  clock.finish_transport("held_out", {});
}

JointSearch RegionSearch::joint_search() const {
  return {problem,        basis->options, basis->control,
          response,       *exact_,        searched_,
          judged,         reported,       transport.cache.indirect_relative_error,
          held_out_.get()};
}

std::optional<Box3f> RegionSearch::wider_region() const {
  const bool may_grow =
      basis->region_may_grow && is_joint(*basis) && !found_.out_of_time && found_.beside_surfaces.empty();
  if (!may_grow) return std::nullopt;
  const std::vector<Column> columns = evaluate_columns(response, found_.others, Evaluation::kTracedVisibility);
  std::vector<Vector3d> lights;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const double norm = contribution_norm(judged, columns[j], found_.others[j].intensity);
    if (norm > kMatters * norm_of_wanted(judged)) lights.push_back(found_.others[j].position);
  }
  const Growth growth = grown_at(transport.cache.grid.region, lights);
  if (growth.lights_at_border >= (comes_close() ? kCrowd : 1)) return growth.region;
  if (comes_close()) return std::nullopt;
  const std::vector<Vector3d> outside = find_light_from_outside(response, *exact_, judged, found_.others);
  if (outside.empty()) return std::nullopt;
  return grown_at(transport.cache.grid.region, outside).region;
}

bool RegionSearch::comes_close() const { return is_explained(found_) || part_left() < kCloseEnough; }

bool RegionSearch::is_clearly_better_than(const RegionSearch& other) const {
  if (!found_.beside_surfaces.empty()) return false;
  const bool fewer = found_.others.size() < other.found_.others.size();
  return found_.error < kClearlyBetter * other.found_.error ||
         (fewer && (part_left() < kCloseEnough || found_.error < kAsClose * other.found_.error));
}

double RegionSearch::part_left() const { return found_.error * judged.target_norm / norm_of_wanted(judged); }

double RegionSearch::missed() const {
  if (found_.held_out.size() == 0) return 0;
  return basis->published.noise > 0 ? held_out_->part_missed(found_.held_out) : held_out_->error(found_.held_out);
}

double RegionSearch::most_missed() const {
  if (!(basis->published.noise > 0)) return kFartherElsewhere * found_.error;
  return found_.times_noise > kKnee ? kMisledAndFar : kMisled;
}

bool RegionSearch::brings_closer() const {
  const Observations& published = basis->published;
  const double without = relative_error(published, Column::Zero(published.wanted.rows(), 3));
  if (!(without <= kExplained * published.noise) || found_.held_out.size() == 0) return true;
  return clearly_smaller(HeldOutSets(*held_out_, 0).residuals({}), found_.held_out);
}

bool RegionSearch::was_misled() const {
  const bool close = basis->published.noise == 0 && part_left() <= kCloseEnough;
  return !found_.out_of_time && basis->options.earlier.empty() && !close && missed() > most_missed();
}

bool RegionSearch::has_many() const {
  const SolveOptions& options = basis->options;
  const bool free = options.earlier.empty() && options.exact_lights == 0 && found_.beside_surfaces.empty();
  return free && !found_.out_of_time && found_.others.size() >= kMany && found_.times_noise < kLittleElse;
}

bool RegionSearch::misses_less_than(const RegionSearch& other) const {
  return found_.held_out.size() > 0 && missed() < other.missed();
}

Optimum RegionSearch::conclude(StageClock& clock) const {
  return is_joint(*basis)
             ? inverse::conclude(joint_search(), found_, clock)
             : optimize_as_published(response, basis->published, tree, basis->options, clock, basis->control);
}

double RegionSearch::exact_error(LightEstimates lights) const {
  exact_->correct(response, lights);
  return relative_error(reported, illumination_of(response, lights));
}

double RegionSearch::held_out_error(const LightEstimates& lights) const {
  return held_out_->relative_l2(HeldOutSets(*held_out_, 0).residuals(lights));
}

}  // namespace chiaro::inverse
