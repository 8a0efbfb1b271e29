#pragma once

#include <string>

#include "cli/json_output.h"
#include "inverse/transport/bake.h"

namespace chiaro::cli {

// header: all but the entries.
JsonObject bake_summary(const inverse::TransportCache& header, const inverse::BakeSummary& summary);

// "counts", "spacing", "origin", "finer_lights", "lights" of a grid.
JsonObject grid_summary(const inverse::LightGrid& grid, std::size_t lights);

// Such as "2803 on a grid of 11 x 6 x 11, 304 of them in finer cells".
std::string text_of_lights(const inverse::LightGrid& grid);

}  // namespace chiaro::cli
