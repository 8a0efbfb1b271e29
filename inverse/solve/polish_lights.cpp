#include "inverse/solve/polish_lights.h"

namespace chiaro::inverse {
namespace {

constexpr int kMostRounds = 4;
constexpr double kAtRest = 2e-4;  // of the region's diagonal

double largest_move(const LightEstimates& a, const LightEstimates& b) {
  double move = 0;
  for (std::size_t j = 0; j < a.size(); ++j) move = std::max(move, (a[j].position - b[j].position).norm());
  return move;
}

}  // namespace

PolishedLights polish_lights(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, const LightEstimates& start) {
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

}  // namespace chiaro::inverse
