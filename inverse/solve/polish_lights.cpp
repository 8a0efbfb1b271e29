#include "inverse/solve/polish_lights.h"

#include <algorithm>
#include <limits>

#include "inverse/solve/settle_positions.h"

namespace chiaro::inverse {
namespace {

constexpr int kGatheredRounds = 4, kTracedRounds = 2;
constexpr double kAtRest = 2e-4;     // of the region's diagonal
constexpr double kSettle = 3e-3;     // first steps across shadow edges, of the region's diagonal
constexpr double kExplained = 1.05;  // times the noise: an error that leaves nothing to mend

double largest_move(const LightEstimates& a, const LightEstimates& b) {
  double move = 0;
  for (std::size_t j = 0; j < a.size(); ++j) move = std::max(move, (a[j].position - b[j].position).norm());
  return move;
}

using Corrector = void (ExactIndirect::*)(const LightResponse&, LightEstimates&) const;

void descend(const ExactIndirect& exact, Corrector correct, int most_rounds, const LightResponse& response,
             const Observations& observations, PolishedLights& polished) {
  const double diagonal = double(response.grid().region.diagonal());
  double move = std::numeric_limits<double>::infinity();
  for (int round = 0; move > kAtRest * diagonal && round < most_rounds; ++round) {
    (exact.*correct)(response, polished.lights);
    const JointRefinement refined = refine_joint(response, observations, polished.lights);
    SettledLights settled = settle_positions(response, observations, refined.lights, kSettle * diagonal);
    move = largest_move(settled.lights, polished.lights);
    polished.lights = std::move(settled.lights);
    polished.error = settled.error;
    ++polished.rounds;
  }
}

}  // namespace

PolishedLights polish_lights(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, const LightEstimates& start) {
  PolishedLights gathered{start, 0, 0};
  descend(exact, &ExactIndirect::correct, kGatheredRounds, response, observations, gathered);
  if (gathered.error <= kExplained * observations.noise) return gathered;
  PolishedLights traced = gathered;
  descend(exact, &ExactIndirect::correct_by_paths, kTracedRounds, response, observations, traced);
  if (traced.error < gathered.error) return traced;
  gathered.rounds = traced.rounds;
  return gathered;
}

}  // namespace chiaro::inverse
