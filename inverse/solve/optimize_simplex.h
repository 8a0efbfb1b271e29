#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

struct SimplexOptimum {
  LightEstimates lights;
  double error = 0;  // (3.6)
  int evaluations = 0;
};

// Nelder–Mead over positions and intensities, section 3.4.3. Positions stay inside the grid's region, intensities ≥ 0.
SimplexOptimum optimize_simplex(const LightResponse& response, const Observations& observations,
                                const LightEstimates& start);

}  // namespace chiaro::inverse
