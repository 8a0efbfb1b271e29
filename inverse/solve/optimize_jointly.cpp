#include "inverse/solve/optimize_jointly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "inverse/solve/choose_light_count.h"
#include "inverse/solve/error_curve.h"
#include "inverse/solve/fit_in_place.h"
#include "inverse/solve/light_intervals.h"
#include "inverse/solve/lights_beside_surfaces.h"
#include "inverse/solve/polish_lights.h"
#include "inverse/solve/sets_without_one.h"
#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

constexpr double kFarFromTarget = 0.1;  // error of lights that do not stand where the target's stood …
constexpr double kFarNoise = 2;         // … or so many times its noise
constexpr double kClearlyLess = 0.98;   // of an error
constexpr double kWorthALight = 1.05;   // times the error of more lights, or less: they are too many
constexpr int kMostLeads = 4;           // descents by held-out receivers …
constexpr std::size_t kAlwaysLed = 8;   // … of as many lights, and of more where more were found
constexpr double kNegligible = 1e-3;    // contribution to the target's norm
constexpr double kHardlySeen = 1e-2;    // the same, of a light that may stand anywhere
constexpr double kSignificant = 10;     // times what noise alone makes of a light: transport errs, too
constexpr std::size_t kMore = 2;        // lights that few important vertices may have hidden

LightEstimates joined(LightEstimates some, const LightEstimates& others) {
  some.insert(some.end(), others.begin(), others.end());
  return some;
}

// At the nearest places where they may stand, and as bright as they may be, where rules say anything of that.
LightEstimates kept_to_rules(const LightResponse& response, const Observations& ruled, LightEstimates lights) {
  const std::vector<Eigen::Vector3d> before = positions_of(lights);
  std::vector<Eigen::Vector3d> positions = before;
  const bool moved = response.places().settle(positions) && positions != before;
  if (lights.empty() || !(moved || ruled.rules.any())) return lights;
  for (std::size_t j = 0; j < lights.size(); ++j) lights[j].position = positions[j];
  refit_intensities(ruled, evaluate_columns(response, lights, Evaluation::kTracedVisibility), lights);
  return lights;
}

// The search becomes one that chose fewer lights, these.
void choose_fewer(const JointSearch& search, const Observations& remaining, const LightEstimates& lights,
                  LightCountResult& count) {
  count.lights = count.sets[lights.size() - 1] = lights;
  count.error = relative_error(remaining, illumination_of(search.response, lights));
  if (count.held_out.size() > 0) count.held_out = HeldOutSets(*search.held_out, 0).residuals(lights);
}

// Where interpolated light misled the search fewer lights may do, if no number was asked for.
PolishedLights polish_chosen(const JointSearch& search, const Observations& last, const LightCountResult& count,
                             const StageClock& clock) {
  const std::span<const LightEstimates> sets(count.sets.data(), count.lights.size());
  return search.options.exact_lights > 0 || count.lights.empty()
             ? polish_lights(search.exact, search.response, last, count.lights, clock)
             : polish_fewest(search.exact, search.response, last, sets, clock);
}

// Without what is known of its important vertices.
BegunSearch begun_with(const JointLights& found) {
  BegunSearch begun{{}, found.others.size()};
  for (const LightEstimates& set : found.sets) {
    if (set.empty() || set.size() > begun.lights + kMore) continue;
    LightEstimates& lights = begun.sets.emplace_back();
    for (const LightEstimate& light : set) lights.push_back({light.position, light.intensity});
  }
  return begun;
}

// beside_surfaces: in all of them but those of fewer lights, which are what is left as the least missed go.
std::vector<LightSet> error_curve_of(const LightResponse& response, const Observations& judged,
                                     const LightEstimates& beside_surfaces, const LightCountResult& count) {
  std::vector<LightSet> curve;
  const auto add = [&](const LightEstimates& lights) {
    if (!lights.empty()) curve.push_back(set_of(lights, relative_error(judged, illumination_of(response, lights))));
  };
  add(beside_surfaces);
  for (const LightEstimates& set : count.sets) {
    if (!set.empty()) add(joined(beside_surfaces, set));
  }
  while (!curve.empty() && curve.front().lights.size() > 1) {
    const auto fewer = sets_without_one(response, judged, light_estimates(curve.front().lights), 1);
    curve.insert(curve.begin(), set_of(fewer[0], relative_error(judged, illumination_of(response, fewer[0]))));
  }
  return curve;
}

// Without the lights that the last descent left with less than what anybody sees of them or noise makes of itself, and
// those that make good what is wrong with one receiver, and stand no one can tell where; one always stays. The first
// `beside_surfaces` are those.
LightEstimates without_negligible(const LightResponse& response, const Observations& judged,
                                  const LightEstimates& lights, std::size_t& beside_surfaces) {
  const std::vector<Column> columns = evaluate_columns(response, lights, Evaluation::kTracedVisibility);
  const std::vector<LightInterval> intervals = light_intervals(response, judged, lights).lights;
  const double of_noise = kSignificant * judged.noise / std::sqrt(double(judged.wanted.size()));
  LightEstimates kept;
  std::size_t kept_beside = 0;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const double norm = contribution_norm(judged, columns[j], lights[j].intensity);
    const bool nowhere = lights.size() <= kMostLightsWithIntervals && !intervals[j].position.array().isFinite().any();
    if (norm > std::max(of_noise, nowhere ? kHardlySeen : kNegligible) * judged.target_norm) {
      kept.push_back(lights[j]);
      kept_beside += j < beside_surfaces ? 1 : 0;
    }
  }
  if (kept.empty()) return lights;
  beside_surfaces = kept_beside;
  return kept;
}

// Of several sets of lights the one to take, and the error of each that a search knows.
struct RefittedLights {
  LightEstimates lights;
  std::vector<LightSet> error_curve;
};

// Lights that are too few, or kept from where they belong, may shine most on receivers that were not among the
// important ones, and robust weights would not see it: all sets are refitted to others.
class SetsByHeldOut {
 public:
  SetsByHeldOut(const JointSearch& search, const StageClock& clock, std::size_t found, bool far)
      : response_(search.response),
        clock_(clock),
        sets_(*search.held_out, 0),
        most_led_(far ? std::max(found, kAlwaysLed) : 0) {}

  // And led to where they come closest to these, which are more than those that led them, if far from the target.
  HeldOutFit refit(LightEstimates& lights) {
    HeldOutFit fit = sets_.refit(lights);
    if (lights.size() > most_led_) return fit;
    for (int k = 0; k < kMostLeads && !clock_.out_of_time(); ++k) {
      if (!sets_.lead_closer(response_, lights, fit)) break;
    }
    return fit;
  }

 private:
  const LightResponse& response_;
  const StageClock& clock_;
  HeldOutSets sets_;
  std::size_t most_led_;  // lights of a set
};

// Where no lights explain the target held-out receivers may also speak for a light that is none to all others, so that
// fewer will do.
RefittedLights refitted_to_held_out(SetsByHeldOut sets, LightEstimates lights, std::vector<LightSet> curve,
                                    bool fewer_may_do) {
  const HeldOutFit all = sets.refit(lights);
  double least = all.error;
  std::vector<std::pair<LightEstimates, double>> fewer;
  for (LightSet& set : curve) {
    if (set.lights.size() == lights.size()) {
      set = set_of(lights, all.relative_l2);
      continue;
    }
    LightEstimates refitted = light_estimates(set.lights);
    const HeldOutFit fit = sets.refit(refitted);
    set = set_of(refitted, fit.relative_l2);
    if (!fewer_may_do || refitted.size() > lights.size()) continue;
    least = std::min(least, fit.error);
    fewer.emplace_back(std::move(refitted), fit.error);
  }
  for (auto& [set, error] : fewer) {
    if (error <= kWorthALight * least) return {std::move(set), std::move(curve)};
  }
  return {std::move(lights), std::move(curve)};
}

// Without receivers that were held out the lights nearly explain the target.
LightEstimates refitted_over_many(const JointSearch& search, LightEstimates lights) {
  const auto intensity = refit_over_many(search.problem, point_lights(lights), search.options, search.control);
  for (std::size_t j = 0; j < lights.size(); ++j) lights[j].intensity = intensity[j];
  return lights;
}

// The lights of a cut, and its nodes. remaining: without rules.
std::tuple<LightEstimates, std::vector<int>> cut_tree(const JointSearch& search, const LightEstimates& beside_surfaces,
                                                      Observations remaining, const LightTree& tree,
                                                      StageClock& clock) {
  const SolveOptions& options = search.options;
  CutOptions cut_options{options.error_threshold.value_or(kDefaultThesisThreshold), 1,
                         options.max_lights - int(beside_surfaces.size())};
  if (options.exact_lights > 0) {
    const int wanted = std::max(1, options.exact_lights - int(beside_surfaces.size()));
    cut_options = {0, wanted, wanted};
  }
  const LightCutResult cut = cut_light_tree(tree, remaining, cut_options);
  clock.finish("lightcut", {{"lights", double(cut.lights.size())}, {"relative_l2", cut.error}});
  remaining.rules = search.problem.intensities;
  return {joined(beside_surfaces, kept_to_rules(search.response, remaining, cut.lights)), cut.nodes};
}

// Further lights make the error clearly less, though not as much less as they would have to.
bool another_explains_more(const std::vector<LightSet>& curve, std::size_t count) {
  double least = std::numeric_limits<double>::infinity(), at_count = least;
  for (const LightSet& set : curve) {
    if (set.lights.size() == count) at_count = set.relative_l2;
    if (set.lights.size() > count) least = std::min(least, set.relative_l2);
  }
  return least < kClearlyLess * at_count && at_count < std::numeric_limits<double>::infinity();
}

}  // namespace

LightEstimates all_of(const JointLights& found) { return joined(found.beside_surfaces, found.others); }

int most_lights(const SolveOptions& options) {
  return options.exact_lights > 0 ? options.exact_lights : options.max_lights;
}

bool ties_lights_together(const SolveProblem& problem) {
  return problem.intensities.any() || !may_share_places(problem);
}

bool may_share_places(const SolveProblem& problem) { return !(problem.places.light_distance > 0); }

std::vector<LightEstimates> earlier_sets(const SolveOptions& options) {
  std::vector<LightEstimates> sets;
  for (const LightSet& set : options.earlier) {
    const int count = int(set.lights.size());
    if (options.exact_lights > 0 ? count != options.exact_lights : count > options.max_lights) continue;
    sets.push_back(light_estimates(set.lights));
  }
  return sets;
}

bool is_explained(const JointLights& found) {
  return found.beside_surfaces.empty() && found.error <= kExplained * found.noise;
}

JointLights search_jointly(const JointSearch& search, LightEstimates beside_surfaces, const LightTree& tree,
                           StageClock& clock) {
  const SolveOptions& options = search.options;
  const LightResponse& response = search.response;
  const auto already = [&] { return int(beside_surfaces.size()); };
  Observations remaining = less(search.searched, response, beside_surfaces);
  remaining.rules = {};
  const bool goes_on = search.begun != nullptr;
  const std::vector<LightEstimates> earlier = earlier_sets(options);
  JointLights found;
  std::tie(found.start, found.cut) = goes_on ? std::tuple(search.begun->start, search.begun->cut)
                                             : cut_tree(search, beside_surfaces, remaining, tree, clock);
  remaining.rules = search.problem.intensities;

  const auto find_the_rest = [&] {
    if (already() >= most_lights(options)) return LightCountResult{};
    return choose_light_count(
        response, remaining, tree,
        {options.max_lights - already(), std::max(0, options.exact_lights - already()), clock.seconds_left(),
         search.transport_error, &search.exact, search.held_out, search.control, earlier,
         goes_on ? begun_with(*search.begun) : BegunSearch{}, already() > 0 ? nullptr : &search.judged});
  };
  LightCountResult count = find_the_rest();
  if (already() > 0 && !count.out_of_time) {
    // What was found first was found beside the light of all others.
    beside_surfaces =
        refine_lights_beside_surfaces(response, search.exact, search.judged, beside_surfaces, count.lights);
    std::erase_if(beside_surfaces, is_dark);
    remaining = less(search.searched, response, beside_surfaces);
    count = find_the_rest();
  }
  clock.finish("joint_refinement",
               {{"refinements", count.refinements}, {"relative_l2", count.error}, {"noise", remaining.noise}});
  // The last descents are by (3.6) itself, which the result is judged by; but not where lights beside surfaces make it
  // blind to all others.
  const Observations& last = beside_surfaces.empty() ? search.judged : remaining;
  PolishedLights polished = polish_chosen(search, last, count, clock);
  if (polished.started_with < count.lights.size()) choose_fewer(search, remaining, polished.lights, count);
  Observations by_rules = search.reported;
  by_rules.rules = search.judged.rules;
  found.error_curve = error_curve_of(response, by_rules, beside_surfaces, count);
  clock.finish("polish",
               {{"lights", double(count.lights.size())}, {"rounds", polished.rounds}, {"relative_l2", polished.error}});
  found.beside_surfaces = std::move(beside_surfaces);
  found.others = std::move(polished.lights);
  found.error = polished.error;
  found.noise = last.noise;
  found.times_noise = remaining.noise > 0 ? count.error / remaining.noise : std::numeric_limits<double>::infinity();
  found.held_out = std::move(count.held_out);
  found.sets = std::move(count.sets);
  const auto same = std::find_if(earlier.begin(), earlier.end(),
                                 [&](const LightEstimates& set) { return set.size() == found.others.size(); });
  if (same != earlier.end()) found.start = *same;
  found.out_of_time = count.out_of_time || clock.out_of_time();
  return found;
}

Optimum conclude(const JointSearch& search, const JointLights& found, StageClock& clock) {
  const SolveOptions& options = search.options;
  const bool explained = is_explained(found), tied = ties_lights_together(search.problem);
  // Of what lights cannot produce each objective leaves something else, and lights settle by (3.6) alone.
  const bool judged_otherwise = options.objective != Objective::kL2 && !explained;
  // Noise of the target, and of the transport that was searched by.
  const double far_from_target = std::max(kFarFromTarget, kFarNoise * search.searched.noise);
  const bool far = found.beside_surfaces.empty() && found.error > far_from_target;
  const LightEstimates as_found = all_of(found);
  const bool refitted = !as_found.empty() && !found.out_of_time && !explained && (far || tied);
  RefittedLights at_last{as_found, found.error_curve};
  if (refitted && search.held_out != nullptr) {
    at_last = refitted_to_held_out({search, clock, as_found.size(), far}, as_found, found.error_curve,
                                   far && options.exact_lights == 0);
  } else if (refitted) {
    at_last.lights = refitted_over_many(search, as_found);
  }
  if (refitted) clock.finish("intensities_over_many", {{"lights", double(at_last.lights.size())}});
  auto& [all, error_curve] = at_last;
  const bool share_places = may_share_places(search.problem);
  if (share_places) let_none_be_worse_than_fewer(error_curve);
  const LightEstimates exactly = share_places ? as_many_as_asked_for(all, std::size_t(options.exact_lights)) : all;
  std::size_t held = found.beside_surfaces.size();
  LightEstimates lights =
      options.exact_lights > 0 ? exactly : without_negligible(search.response, search.judged, all, held);
  const Termination termination =
      found.out_of_time                                                ? Termination::kTimeLimit
      : options.exact_lights > 0                                       ? Termination::kAsManyAsAskedFor
      : !search.options.earlier.empty()                                ? Termination::kEarlierRefined
      : !explained && lights.size() == std::size_t(options.max_lights) ? Termination::kAsManyAsAllowed
      : another_explains_more(error_curve, lights.size())              ? Termination::kFurtherExplainLittleMore
                                                                       : Termination::kNoFurtherExplainsMore;
  return {std::move(lights),
          found.start,
          termination,
          found.cut,
          std::move(error_curve),
          !found.out_of_time && (far || tied || judged_otherwise),
          !found.out_of_time && !far && !tied && !judged_otherwise,
          held,
          refitted && search.held_out != nullptr};
}

}  // namespace chiaro::inverse
