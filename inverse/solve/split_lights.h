#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Sets with one light more, in each of which one light of `lights` stands in two places: to either side of its own, or
// there and beside, in the direction in which the residual asks for it most (the least eigenvalue of the misfit's second
// derivative, that of the Gauss–Newton matrix left out). Best first, with intensities fitted, at most `most`.
// Source: Wu, Wang, Liu, Splitting steepest descent for growing neural architectures, 2019.
std::vector<LightEstimates> propose_splits(const LightResponse& response, const Observations& observations,
                                           const LightEstimates& lights, std::size_t most);

}  // namespace chiaro::inverse
