#pragma once

#include "inverse/solve/settling_bench.h"

namespace chiaro::inverse {

// Lights that many receivers lack, up to so many, and nothing where none is: one at the best of these places, led to
// where its direct light explains most of what `lights` leave, then another beside it, and both again in turn; the
// lights there are stay. Receivers whose shadows are not where the target has them hardly count. indirect[j]: what
// lights[j] brings by bounces at 1 cd; of those that were missed nothing is known.
LightEstimates find_missed_lights(const SettlingBench& bench, const std::vector<Column>& indirect,
                                  const LightEstimates& lights, const std::vector<Eigen::Vector3d>& places,
                                  std::size_t most);

}  // namespace chiaro::inverse
