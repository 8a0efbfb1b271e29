#pragma once

#include <string>
#include <vector>

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// So many of light1, light2 …, past the names that the scene's surfaces, its cameras and the lights that stay lit have.
std::vector<std::string> free_light_names(const SolveProblem& problem, std::size_t count);

}  // namespace chiaro::inverse
