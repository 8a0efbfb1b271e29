#pragma once

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Lights so near a surface, or inside a fixture, that the few receivers beside them hold most of the target's squared
// norm. No grid has a node there, interpolation fails there, and next to such a light all others look like noise, so
// these are found first, one after the other, each by itself, with exact indirect light and by the weights of (3.6).
// At most `most`; none where no few receivers outshine all others.
LightEstimates find_lights_beside_surfaces(const LightResponse& response, const ExactIndirect& exact,
                                           const Observations& observations, int most);

// The same lights where they explain best what `others` leave to them.
LightEstimates refine_lights_beside_surfaces(const LightResponse& response, const ExactIndirect& exact,
                                             const Observations& observations, const LightEstimates& lights,
                                             const LightEstimates& others);

}  // namespace chiaro::inverse
