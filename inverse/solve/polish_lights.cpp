#include "inverse/solve/polish_lights.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "inverse/solve/settle_positions.h"

namespace chiaro::inverse {
namespace {

constexpr int kRounds = 4;
constexpr double kNearNoise = 1.1;  // times it, or less, of an error: no lights leave less
constexpr double kAtRest = 2e-4;    // of the region's diagonal
constexpr JointRefinementOptions kDescent{.max_iterations = 15, .function_tolerance = 1e-4};
constexpr double kSettle = 3e-3;  // first steps across shadow edges, of the region's diagonal

// Metres; the farthest that a light has come from a to b.
double largest_move(const LightEstimates& a, const LightEstimates& b) {
  double move = 0;
  for (std::size_t j = 0; j < a.size(); ++j) move = std::max(move, (a[j].position - b[j].position).norm());
  return move;
}

}  // namespace

PolishedLights polish_lights(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, const LightEstimates& start, const StageClock& clock) {
  PolishedLights polished{start, 0, 0, start.size()};
  const double diagonal = double(response.grid().region.diagonal());
  double move = std::numeric_limits<double>::infinity();
  while (move > kAtRest * diagonal && polished.rounds < kRounds && !clock.out_of_time()) {
    exact.correct(response, polished.lights);
    JointRefinement refined = refine_joint(response, observations, polished.lights, kDescent);
    move = largest_move(refined.lights, polished.lights);
    polished.lights = std::move(refined.lights);
    ++polished.rounds;
  }
  polished.error = relative_error(observations, illumination_of(response, polished.lights));
  if (polished.error <= kExplained * observations.noise || clock.out_of_time()) return polished;
  SettledLights settled = settle_positions(response, observations, polished.lights, kSettle * diagonal,
                                           [&] { return clock.out_of_time(); });
  polished.lights = std::move(settled.lights);
  polished.error = settled.error;
  return polished;
}

PolishedLights polish_fewest(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, std::span<const LightEstimates> sets,
                             const StageClock& clock) {
  PolishedLights best = polish_lights(exact, response, observations, sets.back(), clock);
  for (std::size_t count = sets.size() - 1; count > 0 && !sets[count - 1].empty(); --count) {
    if (best.error <= kNearNoise * observations.noise || clock.out_of_time()) break;
    PolishedLights fewer = polish_lights(exact, response, observations, sets[count - 1], clock);
    if (!(fewer.error < best.error)) break;
    best = std::move(fewer);
  }
  return best;
}

}  // namespace chiaro::inverse
