#pragma once

#include <array>
#include <vector>

namespace chiaro::inverse::numerics {

// A scalar field on the nodes of a regular 3D grid, x fastest.
struct ScalarField {
  std::array<int, 3> counts{};
  std::vector<double> values;  // counts[0] * counts[1] * counts[2]
};

// Watershed by immersion of the inverted field, so that every local maximum of `field` is a basin. Nodes with a value ≤
// 0 belong to none. 26-connected. Plateaus are one basin. Watershed lines are given to the neighbouring basin with the
// highest neighbour, so that every positive node has a label.
// Returns per node the basin's number, 0, 1, … in the order of falling maxima (ties: by node index), or -1.
// Source: Vincent & Soille, Watersheds in Digital Spaces, 1991.
std::vector<int> watershed(const ScalarField& field);

}  // namespace chiaro::inverse::numerics
