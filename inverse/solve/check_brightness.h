#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Error where the brightest channel of the lights found is brighter than files of lights may say.
void check_brightness(const SolveProblem& problem, double brightest);

}  // namespace chiaro::inverse
