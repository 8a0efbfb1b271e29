#pragma once
// From a distribution of lights to few: watershed segmentation, light tree, lightcut.

#include <limits>

#include "inverse/numerics/light_tree.h"
#include "inverse/solve/light_distribution.h"

namespace chiaro::inverse {

// One light per basin of the intensity field on the lattice, section 3.3.2; merged by (3.7) and (3.8).
LightEstimates segment_distribution(const LightDistribution& distribution, const Observations& observations);

// Light tree of section 3.4.1: representatives[k] stands for node k.
struct LightTree {
  numerics::BinaryTree tree;
  LightEstimates representatives;
  std::vector<Column> columns;  // unity lights at the representatives' positions
};

LightTree make_light_tree(const LightResponse& response, const Observations& observations,
                          const LightEstimates& clusters);

struct CutOptions {
  double error_threshold = 0;
  int min_size = 1, max_size = std::numeric_limits<int>::max();
};

struct LightCutResult {
  LightEstimates lights;
  std::vector<int> nodes;           // of the tree, that the lights represent
  double error = 0;                 // (3.6) of the cut
  std::vector<double> error_curve;  // of the cuts with 1, 2, … lights
};

LightCutResult cut_light_tree(const LightTree& tree, const Observations& observations, const CutOptions& options);

}  // namespace chiaro::inverse
