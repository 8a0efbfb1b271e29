#pragma once

#include <vector>

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Of the lights of each only the sum is known: their numbers, from 1, in ascending order.
std::vector<std::vector<int>> groups_not_told_apart(const SolveResult& result);

}  // namespace chiaro::inverse
