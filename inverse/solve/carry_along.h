#pragma once

#include <functional>

#include "inverse/solve/free_lights.h"
#include "inverse/solve/settling_bench.h"

namespace chiaro::inverse {

// Light by bounces becomes that of where the lights are now, and they come down once more.
using CarryAlong = std::function<void(FreeLights&)>;

// True: it was. Where a light has moved close to a surface the few paths that carry_along has do not tell how its
// bright spot there changed: where that leaves clearly more than before, all stays as it was.
bool come_along(const SettlingBench& bench, const CarryAlong& carry_along, FreeLights& free);

}  // namespace chiaro::inverse
