#pragma once
// The best sets that a search knows, of ever more lights.

#include "inverse/solve/observations.h"
#include "inverse/solve/solve.h"

namespace chiaro::inverse {

LightSet set_of(const LightEstimates& lights, double relative_l2);

// In place of the set of as many that is there, if any.
void put_in_curve(LightSet set, std::vector<LightSet>& curve);

// A set of every size up to the largest's, from the smallest's on. One light more never makes a set worse, however the
// search came by it, and no light of a set is dark. Lights may share places.
void let_none_be_worse_than_fewer(std::vector<LightSet>& curve);

// A light that would do nothing is the half of another that stands where it stood: so many lights or more, none of them
// dark; none where all are.
LightEstimates as_many_as_asked_for(LightEstimates lights, std::size_t count);

}  // namespace chiaro::inverse
