#pragma once

#include "inverse/transport/receivers.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

struct BakeSummary {
  double direct_seconds = 0, indirect_seconds = 0, check_seconds = 0;
  std::size_t shadow_rays = 0, gather_rays = 0, gather_points = 0;
};

struct BakeResult {
  TransportCache cache;
  BakeSummary summary;
};

// Transport from every light of the grid to every receiver: direct visibility, and indirect light through shared gather
// points (gather_operator.h).
BakeResult bake(const renderer::RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                const BakeSettings& settings, const renderer::Control& control = {});

}  // namespace chiaro::inverse
