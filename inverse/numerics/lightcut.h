#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "inverse/numerics/light_tree.h"

namespace chiaro::inverse::numerics {

struct LightcutOptions {
  double error_threshold = 0.02;
  int min_size = 1;
  int max_size = std::numeric_limits<int>::max();
};

struct Lightcut {
  std::vector<int> nodes;           // the cut, ascending
  std::vector<double> error_curve;  // error of the cut of size 1, 2, …, nodes.size()
  double error = 0;
};

// From the root, one refinement at a time: of all inner nodes of the cut, the one whose replacement by its two children
// lowers error(cut) most (or raises it least) is replaced; until error ≤ threshold and size ≥ min_size, or max_size is
// reached, or all are leaves.
// Source: Walter et al., Lightcuts, 2005; thesis section 3.4.2.
Lightcut choose_lightcut(const BinaryTree& tree, const std::function<double(const std::vector<int>& cut)>& error,
                         const LightcutOptions& options);

}  // namespace chiaro::inverse::numerics
