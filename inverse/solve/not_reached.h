#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Where most of the error is that noise does not explain, the worst places first. Where the lights come as close to the
// target as one sees on the whole, only places that by themselves are far from it. noise: relative L2 of target and
// illumination together.
std::vector<NotReached> places_not_reached(const Target& target, const std::vector<Vec3f>& illumination, double noise);

// A place that is no better known than to somewhere in the region is not known: intervals larger than the region become
// infinite.
void leave_unknown_beyond_region(SolveResult& result);

// Nobody knows how far off lights are that the border of their region holds while the target is not reached: their
// intervals become infinite.
void leave_unknown_at_border(const SolveProblem& problem, SolveResult& result);

// What may help, one sentence.
std::string advice_for(const SolveProblem& problem, const SolveOptions& options, const SolveResult& result);

}  // namespace chiaro::inverse
