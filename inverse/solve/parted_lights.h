#pragma once

#include <optional>

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// One light more: one of them has stood for two, which many receivers tell where a thousand could not. Nothing where
// none clearly has. `response` is of direct light alone, and indirect[j] what light j brings by bounces at 1 cd, and so
// do its parts (as in instrumental_fit.h).
std::optional<LightEstimates> parted(const renderer::RayTracer& tracer, const LightResponse& response,
                                     const Observations& observations, const std::vector<Column>& indirect,
                                     const LightEstimates& lights);

}  // namespace chiaro::inverse
