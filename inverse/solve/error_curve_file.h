#pragma once

#include <filesystem>

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// "error_curve" of the summary of a solve, or of its report's stages.json. Error, naming the place, for any other file.
std::vector<LightSet> load_error_curve(const std::filesystem::path& path);

}  // namespace chiaro::inverse
