#pragma once

#include <optional>

#include "inverse/solve/settling_bench.h"

namespace chiaro::inverse {

// Where a further light may be sought.
struct FurtherLights {
  std::vector<Eigen::Vector3d> places;  // where one may have been missed
  std::vector<LightEstimates> sets;     // others that a search found, of any number of lights
};

// One light more: one was missed, or one of them has stood for two, which many receivers tell where a thousand could
// not; or several, up to so many, that the others hide while all of them are missing. Nothing where none clearly has.
// indirect[j]: what light j brings by bounces at 1 cd, and so do its parts, and lights of another set that it is the
// nearest to; of those that were missed nothing is known.
std::optional<LightEstimates> with_further_light(const renderer::RayTracer& tracer, const SettlingBench& bench,
                                                 const std::vector<Column>& indirect, const LightEstimates& lights,
                                                 const FurtherLights& further, std::size_t most);

}  // namespace chiaro::inverse
