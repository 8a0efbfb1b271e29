#pragma once

#include "inverse/target/target.h"

namespace chiaro::inverse {

// Standard errors of some receivers' illumination, cd/m², each the root mean square of those of the receivers about it.
// A receiver's own comes from a few batches of paths, and has no part in it: weights by it favour those whose batches
// agree by chance, which mostly are those that missed what few paths bring, and fits would come out too dark. Empty
// where the target does not say.
std::vector<float> pooled_standard_errors(const Target& target, const std::vector<std::size_t>& chosen);

}  // namespace chiaro::inverse
