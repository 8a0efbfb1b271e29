#pragma once

#include "inverse/solve/lights_by_trace.h"
#include "inverse/solve/optimize_jointly.h"

namespace chiaro::inverse {

// The last step of lights that explain the target or nearly so, by the very trace that judges them: it has no error of
// interpolation, of gather points or of a thousand receivers. Lights that the others do as well without go, one that
// stood for two becomes two, and those that were missed come in. The trace becomes that of the settled lights: their
// direct light is taken where they stand in the end, and the light by bounces is carried along by what an eighth of the
// very same paths say of the change. Lights that go farther are traced again: they approach their places by traces of
// fewer paths, of which the last is a part of the trace that they settle by. All of that takes what is left of the
// target for noise, of which it follows no more than it must: where it is paint that no light makes, lights may go
// astray.
LightsByTrace settle_by_trace(const SolveProblem& problem, const SolveOptions& options,
                              const renderer::Control& control, const LightResponse& search, const Optimum& found,
                              StageClock& clock);

}  // namespace chiaro::inverse
