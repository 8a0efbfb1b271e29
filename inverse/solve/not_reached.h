#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Where most of the error is that noise does not explain, the worst places first. Where the lights come as close to the
// target as one sees on the whole, only places that by themselves are far from it. noise: relative L2 of target and
// illumination together.
std::vector<NotReached> places_not_reached(const Target& target, const std::vector<Vec3f>& illumination, double noise);

// What may help, one sentence.
std::string advice_for(const SolveProblem& problem, const SolveOptions& options, const SolveResult& result);

}  // namespace chiaro::inverse
