#pragma once

#include <optional>

#include "inverse/solve/light_intervals.h"
#include "inverse/solve/optimize_jointly.h"
#include "inverse/solve/traced_light.h"

namespace chiaro::inverse {

// Lights, and what they are judged by.
struct LightsByTrace {
  LightEstimates lights;
  FreshTrace traced;                          // its sum is that of these lights
  std::optional<LightIntervals> intervals{};  // absent: they did not settle, or not all of them
  double settling_seconds = 0;                // without the traces
};

// As they are.
LightsByTrace trace_lights(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                           const LightEstimates& lights, StageClock& clock);

// The last step of lights that explain the target or nearly so, by the very trace that judges them: it has no error of
// interpolation, of gather points or of a thousand receivers. Lights that the others do as well without go. The trace
// becomes that of the settled lights: their direct light is taken where they stand in the end, and the light by bounces
// as it was traced, which hardly changes over so short a way; lights that go farther are traced again.
LightsByTrace settle_by_trace(const SolveProblem& problem, const SolveOptions& options,
                              const renderer::Control& control, const LightResponse& search, const Optimum& found,
                              StageClock& clock);

}  // namespace chiaro::inverse
