#pragma once

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/refine_joint.h"

namespace chiaro::inverse {

struct PolishedLights {
  LightEstimates lights;
  double error = 0;  // (3.6), no interpolation
  int rounds = 0;
};

// The last descent, without interpolation: indirect light is computed at the lights' very positions, and its difference
// from the interpolated one is carried along as a constant while the lights are refined and settle across shadow
// edges; again until they rest. By gathering first, and by path tracing where that leaves more than the noise.
PolishedLights polish_lights(const ExactIndirect& exact, const LightResponse& response,
                             const Observations& observations, const LightEstimates& start);

}  // namespace chiaro::inverse
