#pragma once

#include "inverse/transport/gather_operator.h"

namespace chiaro::inverse {

// Times as many gather points as wanted, at most, where much is hidden.
inline constexpr std::size_t kMostGatherPoints = 3;

// Makes so many of the samples gather points, and some more where none of these is seen; each of all the samples is of
// the cell of the point that stands for it. Fills points, cells and `nearest`. control: to be interrupted.
void place_gather_points(GatherOperator& gather, const renderer::RayTracer& tracer,
                         const std::vector<renderer::SurfaceSample>& samples, std::size_t wanted,
                         const renderer::Control& control = {});

}  // namespace chiaro::inverse
