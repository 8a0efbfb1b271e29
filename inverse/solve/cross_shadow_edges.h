#pragma once

#include "inverse/solve/settling_bench.h"

namespace chiaro::inverse {

// Descents follow light that changes smoothly, and take receivers for outliers that a step across a shadow's edge would
// light or hide. Where bright ones seem to be lit or hidden that should not be, each light looks around for a place
// from which fewer are. indirect[j]: as in SettlingBench. True: one moved; intensities stay.
bool cross_shadow_edges(const renderer::RayTracer& tracer, const SettlingBench& bench,
                        const std::vector<Column>& indirect, LightEstimates& lights);

}  // namespace chiaro::inverse
