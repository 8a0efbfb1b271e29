#pragma once
// The coarsest light grid between whose lights interpolation is right to a given error.

#include "inverse/transport/receivers.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

// As make_light_grid; where options.error is set, as coarse as it allows. That is the median over random positions of
// the relative L2 distance between interpolated and exact illumination, at some of the receivers. Error where it takes
// more lights than kMostGridLights.
LightGrid choose_light_grid(const renderer::RayTracer& tracer, const Receivers& receivers,
                            const LightGridOptions& options, const BakeSettings& settings,
                            const renderer::Control& control = {});

inline constexpr std::size_t kMostGridLights = 50'000;

// Positions where a light may stand: the nearest node of the grid is not left out.
std::vector<Vec3f> random_light_positions(const LightGrid& grid, std::size_t count, std::uint64_t seed);

}  // namespace chiaro::inverse
