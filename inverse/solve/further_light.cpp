#include "inverse/solve/further_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/directly_lit.h"
#include "inverse/solve/insertion.h"
#include "inverse/solve/missed_lights.h"
#include "inverse/solve/refine_joint.h"
#include "inverse/solve/split_lights.h"
#include "inverse/transport/receivers.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kSome = 4000;     // receivers that tell where a further light may stand
constexpr std::size_t kMostSplits = 2;  // that are followed
constexpr double kWorthTrying = 0.004;  // of the squared error, that it takes off where it is proposed …
constexpr double kGain = 0.006;         // of the squared error: what a further light must explain …
constexpr double kSignificant = 3.5;    // … and standard errors; one too many goes by the next trace
constexpr std::size_t kMostMissed = 4;  // at a time
constexpr JointRefinementOptions kDescent{.max_iterations = 20, .function_tolerance = 1e-4};

// A settling's own steps (instrumental_fit.h) start near where they end; from farther away they may come to anywhere.
void descend(const SettlingBench& bench, const std::vector<Column>& indirect, LightEstimates& lights) {
  lights = with_corrections(std::move(lights), indirect);
  lead_lights(bench.response, bench.observations, kDescent, lights);
}

// Lights, and what each brings by bounces, at 1 cd, to some and to all receivers.
struct Candidate {
  LightEstimates lights;
  std::vector<Column> to_some, to_all;

  void descend_by_some(const SettlingBench& some) { descend(some, to_some, lights); }
  void descend_by_all(const SettlingBench& all) { descend(all, to_all, lights); }
};

std::vector<Column> rows_of(const std::vector<Column>& columns, const std::vector<std::size_t>& rows) {
  std::vector<Column> some;
  for (const Column& column : columns) some.emplace_back(column(rows, Eigen::all));
  return some;
}

Column zero_like(const Column& column) { return Column::Zero(column.rows(), 3); }

// One of the lights in two parts, of which each brings by bounces what the whole did.
Candidate in_parts(const Candidate& whole, Split split) {
  Candidate parts{std::move(split.lights), whole.to_some, whole.to_all};
  for (LightEstimate& light : parts.lights) light.correction = Column();
  parts.to_some.push_back(whole.to_some[split.parted]);
  parts.to_all.push_back(whole.to_all[split.parted]);
  return parts;
}

Candidate with_one_more(const Candidate& before, const LightEstimate& light) {
  Candidate more = before;
  more.lights.push_back(light);
  more.to_some.push_back(zero_like(before.to_some.front()));
  more.to_all.push_back(zero_like(before.to_all.front()));
  return more;
}

std::size_t nearest_of(const LightEstimates& lights, const Eigen::Vector3d& place) {
  const auto nearer = [&](const LightEstimate& a, const LightEstimate& b) {
    return (a.position - place).squaredNorm() < (b.position - place).squaredNorm();
  };
  return std::size_t(std::min_element(lights.begin(), lights.end(), nearer) - lights.begin());
}

// Other lights, of which each brings by bounces what the nearest of those before does.
Candidate in_place_of(const Candidate& before, const LightEstimates& others) {
  Candidate candidate;
  for (const LightEstimate& light : others) {
    const std::size_t nearest = nearest_of(before.lights, light.position);
    candidate.lights.push_back({light.position, light.intensity});
    candidate.to_some.push_back(before.to_some[nearest]);
    candidate.to_all.push_back(before.to_all[nearest]);
  }
  return candidate;
}

// Sets of one light more that take this part off the squared error where they are proposed, or that a search found.
std::vector<Candidate> worth_trying(const SettlingBench& some, const Candidate& before, const FurtherLights& further) {
  const LightEstimates lights = with_corrections(before.lights, before.to_some);
  const Observations left = less(some.observations, some.response, lights);
  const double squared_error = std::pow(some.norm(left.wanted), 2);
  std::vector<Candidate> candidates;
  for (Split& split : propose_splits(some.response, some.observations, lights, kMostSplits)) {
    const double squared = std::pow(split.error * some.observations.target_norm, 2);
    if (squared < (1 - kWorthTrying) * squared_error) candidates.push_back(in_parts(before, std::move(split)));
  }
  const auto missed = propose_directly_lit(some.response, left, further.places, kWorthTrying * squared_error);
  if (missed) candidates.push_back(with_one_more(before, *missed));
  for (const LightEstimates& set : further.sets) {
    if (set.size() == lights.size() + 1) candidates.push_back(in_place_of(before, set));
  }
  return candidates;
}

// With one light more, all of them led on.
std::optional<LightEstimates> with_one_led(const SettlingBench& all, const SettlingBench& some, Candidate now,
                                           const FurtherLights& further) {
  std::vector<Candidate> candidates = worth_trying(some, now, further);
  if (candidates.empty()) return {};

  // Descents end here or there beside a shadow's edge: the lights of before come down as often. Most of the receivers
  // that tell have not led any of them.
  const auto brought_by = [&](const Candidate& candidate) {
    return all.illumination(candidate.to_all, candidate.lights);
  };
  const Column before = brought_by(now);
  now.descend_by_some(some);
  const Column led = brought_by(now);
  std::erase_if(candidates, [&](Candidate& more) {
    if (all.stops()) return true;
    more.descend_by_some(some);
    return !all.explains_more(brought_by(more), led, kGain, kSignificant);
  });
  if (candidates.empty() || all.stops()) return {};
  now.descend_by_all(all);
  const Column again = brought_by(now);
  Column least = relative_error(all.observations, again) < relative_error(all.observations, before) ? again : before;
  std::optional<LightEstimates> best;
  for (Candidate& more : candidates) {
    if (all.stops()) return {};
    more.descend_by_all(all);
    Column brought = brought_by(more);
    if (!all.explains_more(brought, least, kGain, kSignificant)) continue;
    least = std::move(brought);
    best = std::move(more.lights);
  }
  return best;
}

// Where a search had a light in any of its sets, too.
std::vector<Eigen::Vector3d> places_of_missed(const FurtherLights& further) {
  std::vector<Eigen::Vector3d> places = further.places;
  for (const LightEstimates& set : further.sets) {
    for (const LightEstimate& light : set) places.push_back(light.position);
  }
  return places;
}

// With lights that were missed, the others where they are: those that each clearly explain more.
std::optional<LightEstimates> with_missed(const SettlingBench& all, const SettlingBench& some, const Candidate& before,
                                          const FurtherLights& further, std::size_t most) {
  if (most == 0) return {};
  std::optional<LightEstimates> best;
  Candidate now = before;
  Column brought = all.illumination(now.to_all, now.lights);
  for (const LightEstimate& missed : find_missed_lights(some, before.to_some, before.lights, places_of_missed(further),
                                                        std::min(most, kMostMissed))) {
    if (all.stops()) return {};
    Candidate more = with_one_more(now, missed);
    Column with_it = all.illumination(more.to_all, more.lights);
    if (!all.explains_more_to_most(with_it, brought, kGain, kSignificant)) continue;
    brought = std::move(with_it);
    now = std::move(more);
    best = now.lights;
  }
  return best;
}

}  // namespace

std::optional<LightEstimates> with_further_light(const renderer::RayTracer& tracer, const SettlingBench& all,
                                                 const std::vector<Column>& indirect, const LightEstimates& lights,
                                                 const FurtherLights& further, std::size_t most) {
  if (lights.empty()) return {};
  const std::vector<std::size_t> rows = evenly_spread(all.response.receiver_count(), kSome);
  const DirectlyLit directly_lit(tracer, all.response, numerics::chosen_from(all.response.receivers(), rows));
  const SettlingBench some{directly_lit.response(), rows_of(all.observations, rows), all.stop};
  const Candidate now{lights, rows_of(indirect, rows), indirect};
  std::optional<LightEstimates> led = with_one_led(all, some, now, further);
  return led || all.stops() ? led : with_missed(all, some, now, further, most);
}

}  // namespace chiaro::inverse
