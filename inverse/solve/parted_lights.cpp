#include "inverse/solve/parted_lights.h"

#include <cmath>
#include <utility>

#include "inverse/solve/directly_lit.h"
#include "inverse/solve/held_out.h"
#include "inverse/solve/instrumental_fit.h"
#include "inverse/solve/split_lights.h"
#include "inverse/transport/receivers.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kSome = 4000;     // receivers that tell where the parts may stand
constexpr std::size_t kMostSplits = 2;  // that are followed
constexpr double kWorthTrying = 0.004;  // of the squared error, that a split takes off where its parts are proposed
constexpr double kGain = 0.006;         // of the squared error: what a further light must explain …
constexpr double kSignificant = 4;      // … and standard errors: the receivers that tell are those of the fit

std::vector<renderer::SurfaceSample> samples_of(const LightResponse& response, const std::vector<std::size_t>& rows) {
  std::vector<renderer::SurfaceSample> samples;
  for (const std::size_t row : rows) samples.push_back(response.receivers()[row]);
  return samples;
}

Observations rows_of(const Observations& all, const std::vector<std::size_t>& rows) {
  Observations some;
  some.wanted = all.wanted(rows, Eigen::all);
  some.target = all.target(rows, Eigen::all);
  some.sqrt_weight = all.sqrt_weight(rows);
  some.standard_error = all.standard_error(rows);
  some.measure_target();
  return some;
}

// Each light with what it brings by bounces as its correction.
LightEstimates with_indirect(LightEstimates lights, const std::vector<Column>& indirect) {
  for (std::size_t j = 0; j < lights.size(); ++j) lights[j].correction = indirect[j];
  return lights;
}

// Lights, and what they bring by bounces to some receivers.
struct Parted {
  LightEstimates lights;
  std::vector<Column> indirect;
  std::vector<std::size_t> part_of;  // the light of before
};

Parted taken_apart(LightEstimates split, const LightEstimates& before) {
  Parted parted{std::move(split), {}, {}};
  for (LightEstimate& light : parted.lights) {
    std::size_t whole = 0;
    while (before[whole].correction != light.correction) ++whole;
    parted.part_of.push_back(whole);
    parted.indirect.push_back(std::exchange(light.correction, Column()));
  }
  return parted;
}

double error_of(const LightResponse& response, const Observations& observations, const LightEstimates& lights) {
  return relative_error(observations, illumination_of(response, lights));
}

Eigen::VectorXd residuals(const LightResponse& response, const Observations& observations,
                          const std::vector<Column>& indirect, const LightEstimates& lights) {
  return relative_residuals(observations, illumination_of(response, with_indirect(lights, indirect)));
}

}  // namespace

std::optional<LightEstimates> parted(const renderer::RayTracer& tracer, const LightResponse& response,
                                     const Observations& observations, const std::vector<Column>& indirect,
                                     const LightEstimates& lights) {
  const std::vector<std::size_t> rows = evenly_spread(response.receiver_count(), kSome);
  const DirectlyLit some(tracer, response, samples_of(response, rows));
  const Observations of_some = rows_of(observations, rows);
  std::vector<Column> indirect_of_some;
  for (const Column& column : indirect) indirect_of_some.push_back(column(rows, Eigen::all));
  const LightEstimates whole = with_indirect(lights, indirect_of_some);

  // Some of the receivers lead them most of the way.
  const auto descend = [&](const std::vector<Column>& of_few, const std::vector<Column>& of_all, LightEstimates& set) {
    descend_with_instruments(some.response(), of_some, of_few, set);
    descend_with_instruments(response, observations, of_all, set);
    fit_intensities_with_instruments(response, observations, of_all, set);
    return residuals(response, observations, of_all, set);
  };
  const double squared_error = std::pow(error_of(some.response(), of_some, whole), 2);
  const double of_all_squared = std::pow(error_of(response, observations, with_indirect(lights, indirect)), 2);
  const Eigen::VectorXd before = residuals(response, observations, indirect, lights);
  std::optional<LightEstimates> best;
  double least = before.sum();
  for (LightEstimates& split : propose_splits(some.response(), of_some, whole, kMostSplits)) {
    if (std::pow(error_of(some.response(), of_some, split), 2) > (1 - kWorthTrying) * squared_error) continue;
    Parted parts = taken_apart(std::move(split), whole);
    std::vector<Column> of_all;
    for (const std::size_t j : parts.part_of) of_all.push_back(indirect[j]);
    const Eigen::VectorXd after = descend(parts.indirect, of_all, parts.lights);
    if (!(after.sum() < least) || !clearly_smaller(before, after, kSignificant)) continue;
    const double squared = std::pow(error_of(response, observations, with_indirect(parts.lights, of_all)), 2);
    if (squared > (1 - kGain) * of_all_squared) continue;
    // Descents end here or there beside a shadow's edge: one more of them is to do no better.
    LightEstimates again = lights;
    if (!clearly_smaller(descend(indirect_of_some, indirect, again), after, kSignificant)) continue;
    least = after.sum();
    best = std::move(parts.lights);
  }
  return best;
}

}  // namespace chiaro::inverse
