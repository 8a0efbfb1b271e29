#pragma once

#include "inverse/solve/carry_along.h"

namespace chiaro::inverse {

// Those go without which the others, which come down again, explain as much; one always stays. Fewer lights that come
// near that are carried along before they are given up; carry_along: empty where lights are on their way. Returns how
// sure those are that stay.
LightIntervals remove_needless(const SettlingBench& bench, const CarryAlong& carry_along, FreeLights& free);

}  // namespace chiaro::inverse
