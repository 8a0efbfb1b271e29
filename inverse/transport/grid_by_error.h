#pragma once
// The coarsest light grid between whose lights interpolation is right to a given error, finer where that takes it.

#include "inverse/transport/receivers.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

// As make_light_grid; where options.error is set, as coarse as it allows. That is the median over random positions of
// the relative L2 distance between interpolated and exact illumination, at some of the receivers. Cells where it is
// four times as far are halved, up to kMostLevels times, for up to as many further lights. Error where the
// median takes more lights than kMostGridLights.
LightGrid choose_light_grid(const renderer::RayTracer& tracer, const Receivers& receivers,
                            const LightGridOptions& options, const BakeSettings& settings,
                            const renderer::Control& control = {});

inline constexpr std::size_t kMostGridLights = 50'000;

}  // namespace chiaro::inverse
