#pragma once

#include <string>

#include "cli/json_output.h"
#include "inverse/transport/bake.h"

namespace chiaro::cli {

// header: all but the entries.
JsonObject bake_summary(const inverse::TransportCache& header, const inverse::BakeSummary& summary);

// "counts", "spacing", "origin", "lights" of a grid.
JsonObject grid_summary(const inverse::LightGrid& grid, std::size_t lights);

}  // namespace chiaro::cli
