#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Two lights far apart may together have passed for one between them, which no step leads away from. The sets with one
// light more in which two lights of the grid take the place of one, those that explain most of what it did and what is
// left: at most so many, best first.
std::vector<LightEstimates> propose_pairs(const LightResponse& response, const Observations& observations,
                                          const LightEstimates& lights, std::size_t most);

}  // namespace chiaro::inverse
