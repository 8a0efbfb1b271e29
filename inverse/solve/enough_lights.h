#pragma once

#include "inverse/solve/fill_up_lights.h"
#include "inverse/solve/region_search.h"

namespace chiaro::inverse {

// As many as asked for, or one: further ones share a place with others, where they may, and otherwise find their own
// beside fewer lights that were better. True: it took something.
bool fill_up_to_wanted(const SolveProblem& problem, const SolveOptions& options, const RegionSearch& searched,
                       const FillUpLimits& limits, Optimum& optimum);

// The error curve has a set of every size up to the largest's, and one light more never makes a set worse: where lights
// may share places, and otherwise as far as places for them are found.
void complete_curve(const SolveProblem& problem, const RegionSearch& searched, const FillUpLimits& limits,
                    bool by_held_out, std::vector<LightSet>& curve);

}  // namespace chiaro::inverse
