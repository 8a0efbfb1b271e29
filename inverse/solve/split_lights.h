#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// A set with one light more: where one light stood there are two, the first of them in its place in the order, the other
// at the end.
struct Split {
  LightEstimates lights;   // each part with the correction of the whole
  std::size_t parted = 0;  // which one it was
  double error = 0;        // (3.6)
};

// Of each light one such set: its parts stand to either side of its own place, or there and beside, in the direction in
// which the residual asks for it most (the least eigenvalue of the misfit's second derivative, that of the Gauss–Newton
// matrix left out), or in that in which the channels, each by itself, would have it go. Best first, with intensities
// fitted, at most `most`.
// Source: Wu, Wang, Liu, Splitting steepest descent for growing neural architectures, 2019.
std::vector<Split> propose_splits(const LightResponse& response, const Observations& observations,
                                  const LightEstimates& lights, std::size_t most);

}  // namespace chiaro::inverse
