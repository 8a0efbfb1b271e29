#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Error, naming the light and the rule, where one of the lights that stay in place stands where none may. Lights from
// afar stand nowhere.
void check_lights_in_place(const SolveProblem& problem);

}  // namespace chiaro::inverse
