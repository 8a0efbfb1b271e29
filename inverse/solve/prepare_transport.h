#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

struct PreparedTransport {
  TransportCache cache;  // of the chosen receivers only, in their order
};

// Error for a cache file that belongs to other receivers, another scene or other materials.
void require_fitting_cache(const SolveProblem& problem);

// Error where a cache file's transport would serve a region that has no free space. Without one a bake tells.
void require_free_space(const SolveProblem& problem, const renderer::Control& control);

// From the problem's cache file, or baked for the chosen receivers alone. Error for a cache that belongs to other
// receivers, another scene or other materials.
PreparedTransport prepare_transport(const SolveProblem& problem, const std::vector<std::size_t>& chosen,
                                    const renderer::Control& control);

}  // namespace chiaro::inverse
