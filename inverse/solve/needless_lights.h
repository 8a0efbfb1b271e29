#pragma once

#include <functional>

#include "inverse/solve/free_lights.h"
#include "inverse/solve/settling_bench.h"

namespace chiaro::inverse {

// Light by bounces becomes that of where the lights are now, and they come down once more.
using CarryAlong = std::function<void(FreeLights&)>;

// Those go without which the others, which come down again, explain as much; one always stays. Fewer lights that come
// near that are carried along before they are given up; carry_along: empty where lights are on their way. Returns how
// sure those are that stay.
LightIntervals remove_needless(const SettlingBench& bench, const CarryAlong& carry_along, FreeLights& free);

}  // namespace chiaro::inverse
