#pragma once

#include <string>

#include "cli/json_output.h"
#include "inverse/transport/bake.h"

namespace chiaro::cli {

JsonObject bake_summary(const inverse::BakeResult& result);

// "counts", "spacing", "origin", "lights" of a grid.
JsonObject grid_summary(const inverse::LightGrid& grid, std::size_t lights);

double memory_bytes();  // of this machine

// Error where the transport matrix, as it is computed and written, is larger than this machine's memory.
void require_memory_for_bake(const std::string& scene, const inverse::Receivers& receivers,
                             const inverse::LightGrid& grid);

}  // namespace chiaro::cli
