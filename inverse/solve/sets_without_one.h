#pragma once
// Backward elimination: which lights of a set are missed least.

#include <vector>

#include "inverse/solve/observations.h"
#include "inverse/transport/light_response.h"

namespace chiaro::inverse {

// `all` without one light each, the intensities of the others refitted: at most so many of the least errors, the least
// first.
std::vector<LightEstimates> sets_without_one(const LightResponse& response, const Observations& observations,
                                             const LightEstimates& all, std::size_t most);

}  // namespace chiaro::inverse
