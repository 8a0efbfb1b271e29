#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Where most of the error is that noise does not explain, the worst places first; none where the lights come as close
// to the target as one sees. noise: relative L2 of target and illumination together.
std::vector<NotReached> places_not_reached(const Target& target, const std::vector<Vec3f>& illumination, double noise);

// What may help, one sentence.
std::string advice_for(const SolveProblem& problem, const SolveOptions& options, const SolveResult& result);

}  // namespace chiaro::inverse
