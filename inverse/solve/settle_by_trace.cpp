#include "inverse/solve/settle_by_trace.h"

#include <algorithm>
#include <utility>

#include "inverse/solve/carry_along.h"
#include "inverse/solve/cross_shadow_edges.h"
#include "inverse/solve/error_curve.h"
#include "inverse/solve/fill_up_lights.h"
#include "inverse/solve/further_light.h"
#include "inverse/solve/needless_lights.h"
#include "inverse/solve/settling.h"

namespace chiaro::inverse {
namespace {

constexpr int kRounds = 3, kDrafts = 5, kMostFurther = 3;
constexpr double kLeastPaths = 2e6;    // of all receivers together …
constexpr int kEnoughSamples = 256;    // … or so many per receiver
constexpr std::size_t kMany = 30000;   // receivers at most …
constexpr std::size_t kSome = 8000;    // … and while lights are on their way, …
constexpr std::size_t kFarMore = 4;    // … which alone are traced then where there are so many times as many, …
constexpr double kDraftPaths = 5e5;    // … by so many paths of all together
constexpr double kVeryNear = 0.1;      // times as far as light by bounces hardly changes: it does not at all …
constexpr double kCarried = 10;        // … or, so many times as far, can be carried along
constexpr double kAstray = 1.1;        // of the error as found, beyond noise …
constexpr double kNoiseOfNoise = 0.1;  // … and of its squared noise: that of lights that noise has not led
constexpr double kLeastDirect = 0.2;   // of a light's norm: direct light alone is the instrument

// Direct light alone tells of lights here: none of them may be hidden from nearly all receivers.
bool any_hidden(const SettlingBench& bench, const FreeLights& free) {
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    const Column indirect = free.indirect[j] * free.traced[j].intensity.matrix().asDiagonal();
    if (bench.norm(free.brought[j] - indirect) < kLeastDirect * bench.norm(free.brought[j])) return true;
  }
  return false;
}

// Two lights in one place, of which the sum alone is known.
bool any_share_a_place(const LightEstimates& lights, double distance) {
  for (std::size_t j = 0; j < lights.size(); ++j) {
    for (std::size_t k = j + 1; k < lights.size(); ++k) {
      if ((lights[j].position - lights[k].position).norm() < distance) return true;
    }
  }
  return false;
}

// None has moved farther than this, weighed by its share of all light.
bool at_rest(const SettlingBench& bench, const FreeLights& free, double near) {
  for (std::size_t j = 0; j < free.now.size(); ++j) {
    const double share = bench.norm(free.brought[j]) / bench.observations.target_norm;
    if (share * (free.now[j].position - free.traced[j].position).norm() > near) return false;
  }
  return true;
}

// It would take too long, or tell less than the important vertices did.
bool is_worth_it(const SolveOptions& options, std::size_t receivers, std::size_t lights) {
  const int samples = verification_samples(options, receivers);
  const bool precise = samples >= kEnoughSamples || double(samples) * double(receivers) >= kLeastPaths;
  return precise && lights <= kMostLightsWithIntervals;
}

// By direct light, which has no noise that would choose what it brightens. Empty where all receivers are taken anyway.
Eigen::VectorXd brightness_of(const DirectlyLit& receivers, const LightEstimates& lights) {
  const std::size_t count = receivers.response().receiver_count();
  if (count <= kSome) return {};
  return total_illumination(direct_columns(receivers, lights), lights, Eigen::Index(count)).rowwise().norm();
}

// Those that share a place as one.
LightEstimates each_place_once(const LightEstimates& lights) {
  LightEstimates places;
  for (const LightEstimate& light : lights) {
    const auto same = std::find_if(places.begin(), places.end(),
                                   [&](const LightEstimate& other) { return other.position == light.position; });
    if (same == places.end()) {
      places.push_back(light);
    } else {
      same->intensity += light.intensity;
    }
  }
  return places;
}

// A light whose indirect light stayed behind while it moved is led past its place in one round and back in the next.
// The ratio of both moves tells where it would come to rest (Aitken's Δ²).
// earlier: before the round before.
void come_to_rest(const AllowedPlaces& places, const LightEstimates& earlier, const LightEstimates& before,
                  LightEstimates& lights) {
  if (earlier.size() != lights.size() || before.size() != lights.size()) return;
  for (std::size_t j = 0; j < lights.size(); ++j) {
    const Eigen::Vector3d last_move = before[j].position - earlier[j].position;
    const Eigen::Vector3d move = lights[j].position - before[j].position;
    const double ratio = move.dot(last_move) / std::max(last_move.squaredNorm(), 1e-300);
    if (!(ratio < 0 && ratio > -1)) continue;
    const Eigen::Vector3d rest = before[j].position + move / (1 - ratio);
    lights[j].position = places.nearest(rest).value_or(lights[j].position);
  }
}

// Without those that are held.
FurtherLights further_lights(const LightResponse& search, const Optimum& found) {
  FurtherLights further{search.places_near_grid_lights(), {}};
  for (const LightSet& set : found.error_curve) {
    LightEstimates lights = light_estimates(set.lights);
    if (lights.size() <= found.held) continue;
    lights.erase(lights.begin(), lights.begin() + std::ptrdiff_t(found.held));
    further.sets.push_back(std::move(lights));
  }
  return further;
}

// The steps of settle_by_trace().
class Settler {
 public:
  Settler(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
          const LightResponse& search, const LightEstimates& found, std::size_t held, FurtherLights further,
          StageClock& clock)
      : problem_(problem),
        options_(options),
        control_(control),
        clock_(clock),
        all_(problem.tracer, search, problem.target.receivers.samples),
        brightness_(brightness_of(all_, found)),
        with_(problem, all_, brightness_, kMany, held),
        on_the_way_(problem, all_, brightness_, kSome, held),
        further_(std::move(further)) {}

  LightsByTrace settle(const LightEstimates& lights) {
    LightsByTrace by_trace = come_to_rest_from(lights);
    const double allowed = kAstray * kAstray * as_found_->beyond_noise() + kNoiseOfNoise * as_found_->noise;
    by_trace.went_astray = error_on_the_way(part_of(by_trace.traced, on_the_way_.draw)).beyond_noise() > allowed;
    return by_trace;
  }

 private:
  LightsByTrace come_to_rest_from(LightEstimates lights) {
    if (!any_share_a_place(lights, with_.near) && !out_of_time()) approach(lights);
    for (int round = 1;; ++round) {
      FreshTrace first = first_part_ ? *std::exchange(first_part_, std::nullopt) : trace_first_part_of(lights);
      LightsByTrace by_trace = trace_lights(problem_, options_, control_, lights, clock_, first);
      by_trace.settling_seconds = seconds_;
      if (any_share_a_place(lights, with_.near)) return by_trace;
      const FreshTrace drawn = part_of(by_trace.traced, with_.draw);
      FreeLights free = free_lights(with_, lights, drawn);
      const SettlingBench bench{with_.some.response(), wanted_of(with_, free, drawn), stop_};
      if (any_hidden(bench, free)) return by_trace;
      descend(bench, free);
      const CarryAlong carried_along = [&](FreeLights& now) { carry_along_with(bench, first, lights, now); };
      const bool last = round == kRounds + added_lights_;
      const bool rests =
          at_rest(bench, free, kCarried * with_.near) &&
          (at_rest(bench, free, kVeryNear * with_.near) || come_along(bench, carried_along, free) || last);
      LightIntervals intervals = only_needed(bench, rests ? carried_along : nullptr, free);
      if (rests && add_further(bench, free, lights)) continue;
      lights = joined(with_, lights, free);
      if (rests) {
        follow(with_, free, by_trace.traced);
        by_trace.lights = lights;
        if (with_.held == 0) by_trace.intervals = std::move(intervals);
      }
      finish("settling", lights.size(), rests);
      by_trace.settling_seconds = seconds_;
      if (rests || last || out_of_time()) return by_trace;
    }
  }

  bool out_of_time() const { return clock_.out_of_time(); }

  void finish(const char* stage, std::size_t lights, bool rests) {
    seconds_ += clock_.finish(stage, {{"lights", double(lights)}, {"at_rest", rests ? 1 : 0}});
  }

  FreshTrace trace_first_part_of(const LightEstimates& lights) {
    FreshTrace traced = trace_first_part(problem_, point_lights(lights), options_, control_, clock_);
    if (!as_found_) as_found_ = error_on_the_way(part_of(traced, on_the_way_.draw));
    clock_.finish("verification", verification_figures(traced, problem_.target));
    return traced;
  }

  SquaredError error_on_the_way(const FreshTrace& drawn) const {
    return squared_error_of(drawn, problem_.target, on_the_way_.draw);
  }

  // Of the receivers that lights are on their way by: a part of a first part, which is kept, or where that would be far
  // more receivers, by themselves.
  FreshTrace trace_draft_of(const LightEstimates& lights) {
    const std::size_t receivers = on_the_way_.draw.chosen.size();
    if (problem_.target.receivers.size() <= kFarMore * receivers) {
      first_part_ = trace_first_part_of(lights);
      return part_of(*first_part_, on_the_way_.draw);
    }
    const int samples = int(kDraftPaths / double(receivers));
    FreshTrace drawn = trace_drawn(problem_, point_lights(lights), on_the_way_.draw, samples, options_, control_);
    if (!as_found_) as_found_ = error_on_the_way(drawn);
    clock_.finish("draft", {{"receivers", double(receivers)}, {"samples", double(samples)}});
    return drawn;
  }

  // Towards where they will settle, by traces that are drafts, until they would hardly move. None goes.
  void approach(LightEstimates& lights) {
    LightEstimates earlier, before;
    for (int draft = 0; draft < kDrafts && !out_of_time(); ++draft) {
      const FreshTrace drawn = trace_draft_of(lights);
      FreeLights free = free_lights(on_the_way_, lights, drawn);
      const SettlingBench bench{on_the_way_.some.response(), wanted_of(on_the_way_, free, drawn), stop_};
      const bool hidden = any_hidden(bench, free);
      if (!hidden) bench.descend(free.indirect, free.now);
      const bool rests = hidden || at_rest(bench, free, on_the_way_.near);
      if (!rests) {
        first_part_.reset();
        earlier = std::exchange(before, lights);
        if (options_.exact_lights > 0) light_the_dark(free.now);
        lights = joined(on_the_way_, lights, free);
        come_to_rest(on_the_way_.some.response().places(), earlier, before, lights);
      }
      finish("approach", lights.size(), rests);
      if (rests) return;
    }
  }

  // And across the shadows' edges that descents do not see.
  void descend(const SettlingBench& bench, FreeLights& free) const {
    bench.descend(free.indirect, free.now);
    LightEstimates across = free.now;
    if (!cross_shadow_edges(problem_.tracer, bench, free.indirect, across)) return;
    LightEstimates descended = across;
    bench.descend(free.indirect, descended);
    const auto error = [&](const LightEstimates& lights) {
      return relative_error(bench.observations, bench.illumination(free.indirect, lights));
    };
    free.now = error(descended) < error(across) ? std::move(descended) : std::move(across);
  }

  // lights: as the first part was traced with.
  void carry_along_with(const SettlingBench& bench, const FreshTrace& first, const LightEstimates& lights,
                        FreeLights& free) {
    if (out_of_time()) return;
    finish("settling", free.now.size(), false);
    const renderer::Lights moved = point_lights(joined(with_, lights, free));
    const FreshTrace now = trace_by_the_same_paths(problem_, moved, first, options_, control_);
    clock_.finish("verification", verification_figures(now, problem_.target));
    carry_along(with_, first, now, free);
    descend(bench, free);
  }

  // True: one was missing, or several, and they are on their way. Beside lights that are held none is looked for that
  // the others hide.
  bool add_further(const SettlingBench& bench, const FreeLights& free, LightEstimates& lights) {
    const bool may_add =
        options_.exact_lights == 0 && options_.earlier.empty() && int(lights.size()) < options_.max_lights;
    if (!may_add || added_lights_ == kMostFurther || out_of_time()) return false;
    const auto more = with_further_light(problem_.tracer, bench, free.indirect, free.now, further_,
                                         with_.held > 0 ? 0 : std::size_t(options_.max_lights) - lights.size());
    if (!more || out_of_time()) return false;
    ++added_lights_;
    lights.resize(with_.held);
    lights.insert(lights.end(), more->begin(), more->end());
    finish("settling", lights.size(), false);
    approach(lights);
    return true;
  }

  // As many as asked for, or those that matter.
  LightIntervals only_needed(const SettlingBench& bench, const CarryAlong& carry_along, FreeLights& free) const {
    if (options_.exact_lights == 0) return remove_needless(bench, carry_along, free);
    put_out_residue(free.now);
    let_the_dark_share(free);
    return bench.intervals(free.indirect, free.now);
  }

  const SolveProblem& problem_;
  const SolveOptions& options_;
  const renderer::Control& control_;
  StageClock& clock_;
  const DirectlyLit all_;             // receivers
  const Eigen::VectorXd brightness_;  // of each, under the lights as they were found
  const Settling with_, on_the_way_;
  const FurtherLights further_;
  const std::function<bool()> stop_ = [this] { return out_of_time() || control_.stop_requested(); };
  std::optional<FreshTrace> first_part_{};  // of the trace where the lights are in the end; absent: they moved since
  std::optional<SquaredError> as_found_{};  // of the lights as they were found, by what is traced on the way
  double seconds_ = 0;                      // without the traces
  int added_lights_ = 0;
};

}  // namespace

LightsByTrace settle_by_trace(const SolveProblem& problem, const SolveOptions& options,
                              const renderer::Control& control, const LightResponse& search, const Optimum& found,
                              StageClock& clock) {
  LightEstimates all;
  for (const LightEstimate& light : found.lights) all.push_back({light.position, light.intensity});
  LightEstimates lights = all;
  SolveOptions apart = options;
  if (options.exact_lights > 0 && found.held == 0) {
    lights = each_place_once(all);
    apart.exact_lights = int(lights.size());
  }
  if (!is_worth_it(options, problem.target.receivers.size(), lights.size())) {
    return trace_lights(problem, options, control, all, clock);
  }
  Settler settler(problem, apart, control, search, lights, found.held, further_lights(search, found), clock);
  LightsByTrace settled = settler.settle(lights);
  const bool some_dark = std::any_of(settled.lights.begin(), settled.lights.end(), is_dark);
  if (lights.size() == all.size() && !(some_dark && options.exact_lights > 0)) return settled;
  settled.lights = as_many_as_asked_for(std::move(settled.lights), all.size());
  settled.intervals.reset();
  return settled;
}

}  // namespace chiaro::inverse
