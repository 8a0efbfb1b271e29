#pragma once

#include <optional>

#include "inverse/solve/settling_bench.h"

namespace chiaro::inverse {

// One light more: one was missed, or one of them has stood for two, which many receivers tell where a thousand could
// not. Nothing where none clearly has. indirect[j]: what light j brings by bounces at 1 cd, and so do its parts; of one
// that was missed nothing is known. places: where one may have been missed.
std::optional<LightEstimates> with_further_light(const renderer::RayTracer& tracer, const SettlingBench& bench,
                                                 const std::vector<Column>& indirect, const LightEstimates& lights,
                                                 const std::vector<Eigen::Vector3d>& places);

}  // namespace chiaro::inverse
