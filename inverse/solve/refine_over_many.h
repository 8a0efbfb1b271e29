#pragma once

#include "inverse/solve/polish_lights.h"

namespace chiaro::inverse {

struct ManyReceivers {
  const renderer::RayTracer& tracer;
  const LightResponse& response;  // of direct light alone
  const Observations& observations;
  BakeSettings settings;
  const renderer::Control& control;
};

// Refines lights that the important vertices have found over many receivers: these see where shadows end as the few
// cannot, and together they are less noisy. The indirect light of all lights is path traced, a little at each receiver,
// and again where the lights have come to, until they hardly move. `others` stay as they are.
PolishedLights refine_over_many(const ManyReceivers& many, const LightEstimates& start, const LightEstimates& others);

}  // namespace chiaro::inverse
