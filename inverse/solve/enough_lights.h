#pragma once

#include "inverse/solve/fill_up_lights.h"
#include "inverse/solve/region_search.h"

namespace chiaro::inverse {

// As many as asked for, or one: further ones share a place with others, where they may, and otherwise find their own
// beside fewer lights that were better. True: it took something.
bool fill_up_to_wanted(const SolveProblem& problem, const SolveOptions& options, const RegionSearch& searched,
                       const FillUpLimits& limits, Optimum& optimum);

}  // namespace chiaro::inverse
