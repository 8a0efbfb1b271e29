// Watershed segmentation by immersion.
// Source: L. Vincent, P. Soille, Watersheds in Digital Spaces: An Efficient Algorithm Based on Immersion Simulations,
// IEEE PAMI 13(6), 1991: sort the nodes, then flood level by level, at every level first from the basins known so far
// in the order of geodesic distance, then from what is left, which are new basins. Here the water falls from the
// maxima, and a node where two waters meet goes to one of them at once instead of becoming a line.

#include "inverse/numerics/watershed.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace chiaro::inverse::numerics {
namespace {

constexpr int kNoBasin = -1;

struct Flood {
  const ScalarField& field;
  std::vector<int> label;
  int basin_count = 0;
};

// Calls visit(neighbour) for up to 26 neighbours in the order of their indices.
template <typename Visit>
void for_each_neighbour(const std::array<int, 3>& counts, int node, Visit visit) {
  const int x = node % counts[0], y = node / counts[0] % counts[1], z = node / counts[0] / counts[1];
  for (int k = std::max(z - 1, 0); k <= std::min(z + 1, counts[2] - 1); ++k) {
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, counts[1] - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, counts[0] - 1); ++i) {
        const int neighbour = (k * counts[1] + j) * counts[0] + i;
        if (neighbour != node) visit(neighbour);
      }
    }
  }
}

// The basin of the highest labelled neighbour (ties: the lower number, which has the higher maximum), or kNoBasin.
int basin_above(const Flood& flood, int node) {
  int basin = kNoBasin;
  double highest = 0;
  for_each_neighbour(flood.field.counts, node, [&](int neighbour) {
    const int label = flood.label[neighbour];
    const double value = flood.field.values[neighbour];
    if (label == kNoBasin || (basin != kNoBasin && value < highest)) return;
    if (basin == kNoBasin || value > highest || label < basin) basin = label;
    highest = value;
  });
  return basin;
}

// The nodes of one level that touch a basin get its label, then those that touch these, ring by ring; a ring is
// labelled as a whole, so that the order of its nodes does not matter.
void flood_from_basins(Flood& flood, std::span<const int> level) {
  std::vector<int> ring(level.begin(), level.end()), labels, next;
  const double value = flood.field.values[level[0]];
  while (!ring.empty()) {
    labels.clear();
    for (const int node : ring) labels.push_back(basin_above(flood, node));
    next.clear();
    for (std::size_t i = 0; i < ring.size(); ++i) flood.label[ring[i]] = labels[i];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (labels[i] == kNoBasin) continue;
      for_each_neighbour(flood.field.counts, ring[i], [&](int neighbour) {
        if (flood.label[neighbour] == kNoBasin && flood.field.values[neighbour] == value) next.push_back(neighbour);
      });
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    ring.swap(next);
  }
}

// A maximum, with all of its plateau.
void add_basin(Flood& flood, int seed) {
  const double value = flood.field.values[seed];
  const int basin = flood.basin_count++;
  std::vector<int> open{seed};
  flood.label[seed] = basin;
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    for_each_neighbour(flood.field.counts, node, [&](int neighbour) {
      if (flood.label[neighbour] != kNoBasin || flood.field.values[neighbour] != value) return;
      flood.label[neighbour] = basin;
      open.push_back(neighbour);
    });
  }
}

void flood_level(Flood& flood, std::span<const int> level) {
  flood_from_basins(flood, level);
  for (const int node : level) {
    if (flood.label[node] == kNoBasin) add_basin(flood, node);
  }
}

std::vector<int> positive_nodes_falling(const std::vector<double>& values) {
  std::vector<int> nodes;
  for (std::size_t node = 0; node < values.size(); ++node) {
    if (values[node] > 0) nodes.push_back(int(node));
  }
  std::stable_sort(nodes.begin(), nodes.end(), [&](int a, int b) { return values[a] > values[b]; });
  return nodes;
}

void check_shape(const ScalarField& field) {
  const auto& n = field.counts;
  const bool natural = n[0] >= 0 && n[1] >= 0 && n[2] >= 0;
  if (!natural || std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]) != field.values.size()) {
    throw std::invalid_argument("watershed: as many values as grid nodes are needed");
  }
}

}  // namespace

std::vector<int> watershed(const ScalarField& field) {
  check_shape(field);
  Flood flood{field, std::vector<int>(field.values.size(), kNoBasin)};
  const std::vector<int> nodes = positive_nodes_falling(field.values);
  for (std::size_t first = 0, last = 0; first < nodes.size(); first = last) {
    while (last < nodes.size() && field.values[nodes[last]] == field.values[nodes[first]]) ++last;
    flood_level(flood, std::span(nodes).subspan(first, last - first));
  }
  return flood.label;
}

}  // namespace chiaro::inverse::numerics
