#pragma once

#include <optional>

#include "inverse/solve/settling_bench.h"

namespace chiaro::inverse {

// One light more: one of them has stood for two, which many receivers tell where a thousand could not. Nothing where
// none clearly has. indirect[j]: what light j brings by bounces at 1 cd, and so do its parts.
std::optional<LightEstimates> parted(const renderer::RayTracer& tracer, const SettlingBench& bench,
                                     const std::vector<Column>& indirect, const LightEstimates& lights);

}  // namespace chiaro::inverse
