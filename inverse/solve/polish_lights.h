#pragma once

#include <span>

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/refine_joint.h"
#include "inverse/solve/stage_clock.h"

namespace chiaro::inverse {

inline constexpr double kExplained = 1.5;  // times the noise of the target, or less: more receivers hardly tell more

struct PolishedLights {
  LightEstimates lights;
  double error = 0;  // (3.6), no interpolation
  int rounds = 0;
  std::size_t started_with = 0;  // lights
};

// The last descent over the important vertices, without interpolation: indirect light is gathered at the lights' very
// positions, and its difference from the interpolated one is carried along as a constant while the lights are refined;
// again until they rest. Where noise does not explain what is left they settle across shadow edges. Out of time they
// stay where they are.
PolishedLights polish_lights(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, const LightEstimates& start, const StageClock& clock);

// The same of what a search by interpolated light chose, the last of its sets of 1, 2, … lights. Where that leaves more
// than noise the search may have been misled to lights that make good what interpolation errs by: of fewer, in the
// right places, less may be left then, and these are taken.
PolishedLights polish_fewest(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, std::span<const LightEstimates> sets,
                             const StageClock& clock);

}  // namespace chiaro::inverse
