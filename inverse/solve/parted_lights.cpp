#include "inverse/solve/parted_lights.h"

#include <utility>

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/directly_lit.h"
#include "inverse/solve/split_lights.h"
#include "inverse/transport/receivers.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kSome = 4000;     // receivers that tell where the parts may stand
constexpr std::size_t kMostSplits = 2;  // that are followed
constexpr double kWorthTrying = 0.004;  // of the squared error, that parts take off where they are proposed …
constexpr double kPromising = 1;        // … and standard errors, by all receivers, once these have led them
constexpr double kGain = 0.006;         // of the squared error: what a further light must explain …
constexpr double kSignificant = 4;      // … and standard errors: the receivers that tell are those of the fit

// Lights, and what each brings by bounces, at 1 cd, to some and to all receivers.
struct Candidate {
  LightEstimates lights;
  std::vector<Column> to_some, to_all;
};

std::vector<Column> rows_of(const std::vector<Column>& columns, const std::vector<std::size_t>& rows) {
  std::vector<Column> some;
  for (const Column& column : columns) some.emplace_back(column(rows, Eigen::all));
  return some;
}

// One of the lights in two parts, of which each brings by bounces what the whole did.
std::vector<Candidate> worth_trying(const SettlingBench& some, const Candidate& whole) {
  const LightEstimates lights = with_corrections(whole.lights, whole.to_some);
  const double error = relative_error(some.observations, illumination_of(some.response, lights));
  std::vector<Candidate> candidates;
  for (Split& split : propose_splits(some.response, some.observations, lights, kMostSplits)) {
    if (split.error * split.error > (1 - kWorthTrying) * error * error) continue;
    Candidate parts{std::move(split.lights), whole.to_some, whole.to_all};
    for (LightEstimate& light : parts.lights) light.correction = Column();
    parts.to_some.push_back(whole.to_some[split.parted]);
    parts.to_all.push_back(whole.to_all[split.parted]);
    candidates.push_back(std::move(parts));
  }
  return candidates;
}

}  // namespace

std::optional<LightEstimates> parted(const renderer::RayTracer& tracer, const SettlingBench& all,
                                     const std::vector<Column>& indirect, const LightEstimates& lights) {
  const std::vector<std::size_t> rows = evenly_spread(all.response.receiver_count(), kSome);
  const DirectlyLit directly_lit(tracer, all.response, numerics::chosen_from(all.response.receivers(), rows));
  const SettlingBench some{directly_lit.response(), rows_of(all.observations, rows)};
  Candidate whole{lights, rows_of(indirect, rows), indirect};
  std::vector<Candidate> candidates = worth_trying(some, whole);
  if (candidates.empty()) return {};

  // Descents end here or there beside a shadow's edge: the lights of before come down as often. Most of the receivers
  // that tell have not led any of them.
  some.descend(whole.to_some, whole.lights);
  const Column led = all.illumination(whole.to_all, whole.lights);
  std::erase_if(candidates, [&](Candidate& parts) {
    some.descend(parts.to_some, parts.lights);
    return !all.explains_more(all.illumination(parts.to_all, parts.lights), led, kWorthTrying, kPromising);
  });
  if (candidates.empty()) return {};
  all.descend(whole.to_all, whole.lights);
  const Column before = all.illumination(indirect, lights), again = all.illumination(whole.to_all, whole.lights);
  Column least = relative_error(all.observations, again) < relative_error(all.observations, before) ? again : before;
  std::optional<LightEstimates> best;
  for (Candidate& parts : candidates) {
    all.descend(parts.to_all, parts.lights);
    Column brought = all.illumination(parts.to_all, parts.lights);
    if (!all.explains_more(brought, least, kGain, kSignificant)) continue;
    least = std::move(brought);
    best = std::move(parts.lights);
  }
  return best;
}

}  // namespace chiaro::inverse
