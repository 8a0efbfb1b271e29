#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

struct JointRefinement {
  LightEstimates lights;
  double error = 0;  // (3.6)
  int iterations = 0;
};

struct JointRefinementOptions {
  int max_iterations = 40;
  double function_tolerance = 1e-6;
};

// Levenberg–Marquardt over all positions at once, with analytic Jacobians at fixed visibility and the best intensities
// ≥ 0 wherever the lights stand; positions where the response lets lights stand. Never worse than
// `start`, moved there; without lights, and its error infinite, where there is no place for all of them.
JointRefinement refine_joint(const LightResponse& response, const Observations& observations,
                             const LightEstimates& start, const JointRefinementOptions& options = {});

// Leads lights there as if their corrections stayed the same, which they lose. They stay where there is no place for
// all of them.
void lead_lights(const LightResponse& response, const Observations& observations, const JointRefinementOptions& options,
                 LightEstimates& lights);

}  // namespace chiaro::inverse
