#pragma once
// Lights and the path tracing that they are judged by.

#include <optional>

#include "inverse/solve/light_intervals.h"
#include "inverse/solve/stage_clock.h"
#include "inverse/solve/traced_light.h"

namespace chiaro::inverse {

struct LightsByTrace {
  LightEstimates lights;
  FreshTrace traced;                          // its sum is that of these lights; taken apart as they were traced
  std::optional<LightIntervals> intervals{};  // absent: they did not settle, or not all of them
  double settling_seconds = 0;                // without the traces
  bool went_astray = false;                   // as they settled: they were closer to the target before
};

StageFigures verification_figures(const FreshTrace& traced, const Target& target);

// As they are. first_part: of these lights, where it is there already.
LightsByTrace trace_lights(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                           const LightEstimates& lights, StageClock& clock, std::optional<FreshTrace> first_part = {});

// Where they are, with the intensities that come closest to the target by this trace, within the problem's rules: of
// lights that do not explain the target, or that rules tie together.
LightsByTrace refit_by_trace(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
                             const LightEstimates& lights, StageClock& clock);

}  // namespace chiaro::inverse
