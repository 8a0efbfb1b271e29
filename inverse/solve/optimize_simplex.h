#pragma once

#include <functional>

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

struct SimplexOptimum {
  LightEstimates lights;
  double error = 0;  // (3.6)
  int evaluations = 0;
};

// Nelder–Mead over positions and intensities, section 3.4.3. Positions stay inside the grid's region, intensities ≥ 0.
// stop: asked before each step, whether it is to be the last.
SimplexOptimum optimize_simplex(const LightResponse& response, const Observations& observations,
                                const LightEstimates& start, const std::function<bool()>& stop = {});

}  // namespace chiaro::inverse
