#include "inverse/solve/polish_lights.h"

#include <algorithm>

namespace chiaro::inverse {
namespace {

constexpr int kMostRounds = 4;
constexpr double kAtRest = 2e-4;  // of the region's diagonal

double largest_move(const LightEstimates& a, const LightEstimates& b) {
  double move = 0;
  for (std::size_t j = 0; j < a.size(); ++j) move = std::max(move, (a[j].position - b[j].position).norm());
  return move;
}

PolishedLights polish(const ExactIndirect& exact, const LightResponse& response, const Observations& observations,
                      const LightEstimates& start) {
  PolishedLights result{start, 0, 0};
  const double rest = kAtRest * double(response.grid().region.diagonal());
  for (double move = rest + 1; move > rest && result.rounds < kMostRounds; ++result.rounds) {
    exact.correct(response, result.lights);
    JointRefinement refined = refine_joint(response, observations, result.lights);
    move = largest_move(refined.lights, result.lights);
    result.lights = std::move(refined.lights);
    result.error = refined.error;
  }
  return result;
}

}  // namespace

PolishedLights polish_lights(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, const LightEstimates& start) {
  PolishedLights result = polish(exact, response, observations, start);
  const auto direct_only = [](const LightEstimate& light) { return light.direct_only; };
  if (std::none_of(start.begin(), start.end(), direct_only)) return result;
  // A light beside an open surface has indirect light after all: whichever explains the target better.
  LightEstimates open = start;
  for (LightEstimate& light : open) light.direct_only = false;
  PolishedLights other = polish(exact, response, observations, open);
  return other.error < result.error ? other : result;
}

}  // namespace chiaro::inverse
