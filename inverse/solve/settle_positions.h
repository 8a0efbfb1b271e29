#pragma once

#include <functional>

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

struct SettledLights {
  LightEstimates lights;
  double error = 0;  // (3.6)
  int evaluations = 0;
};

// Where derivatives fail: shadow edges cross receivers as a light moves, and descent with fixed visibility stops at the
// first of them. Downhill simplex over the position of one light after the other, all intensities refitted at every
// step by non-negative least squares; corrections stay as they are. `step`: edges of the first simplex, metres. Never
// worse than `start`. stop: if any, whether to end now.
SettledLights settle_positions(const LightResponse& response, const Observations& observations,
                               const LightEstimates& start, double step, const std::function<bool()>& stop = {});

}  // namespace chiaro::inverse
