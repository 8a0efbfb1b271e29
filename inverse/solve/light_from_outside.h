#pragma once

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Places around the region whose light comes in, through windows and other openings, and explains clearly more of the
// target together with the lights found inside than these do alone: those that bring most. Empty: there are none.
std::vector<Eigen::Vector3d> find_light_from_outside(const LightResponse& response, const ExactIndirect& exact,
                                                     const Observations& observations, const LightEstimates& found);

}  // namespace chiaro::inverse
