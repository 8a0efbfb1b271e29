// Greedy agglomerative clustering.
// Source: B. Walter, S. Fernandez, A. Arbree, K. Bala, M. Donikian, D. Greenberg, Lightcuts: A Scalable Approach to
// Illumination, 2005, section 3.1 (the light tree); thesis section 3.4.1. That every node remembers its nearest older
// one is M. Anderberg, Cluster Analysis for Applications, 1973: O(k²) distances, O(k²) work where few share a nearest.

#include "inverse/numerics/light_tree.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace chiaro::inverse::numerics {
namespace {

// Distances from a node to every older one that was alive when it came into being.
struct Candidate {
  std::vector<double> distances;  // by older node
  int nearest = -1;               // alive; ties: the lowest index
};

struct Clustering {
  std::vector<int> alive;  // ascending
  std::vector<Candidate> candidates;

  double nearest_distance(int node) const { return candidates[node].distances[candidates[node].nearest]; }
};

void find_nearest(Clustering& clustering, int node) {
  Candidate& candidate = clustering.candidates[node];
  candidate.nearest = -1;
  for (const int older : clustering.alive) {
    if (older >= node) break;
    const double distance = candidate.distances[older];
    if (candidate.nearest < 0 || distance < candidate.distances[candidate.nearest]) candidate.nearest = older;
  }
}

void add_node(Clustering& clustering, int node, const std::function<double(int, int)>& distance) {
  clustering.candidates.emplace_back();
  std::vector<double>& distances = clustering.candidates.back().distances;
  distances.resize(node, std::numeric_limits<double>::infinity());
  for (const int older : clustering.alive) {
    const double value = distance(older, node);
    if (!std::isnan(value)) distances[older] = value;
  }
  find_nearest(clustering, node);
  clustering.alive.push_back(node);
}

// The node whose nearest older one is closest; ties: the lowest pair.
int closest_node(const Clustering& clustering) {
  int best = clustering.alive[1];
  for (const int node : clustering.alive) {
    if (clustering.candidates[node].nearest < 0) continue;
    const double distance = clustering.nearest_distance(node), lowest = clustering.nearest_distance(best);
    const bool older = clustering.candidates[node].nearest < clustering.candidates[best].nearest;
    if (distance < lowest || (distance == lowest && older)) best = node;
  }
  return best;
}

void retire(Clustering& clustering, int left, int right) {
  std::erase_if(clustering.alive, [&](int node) { return node == left || node == right; });
  for (const int dead : {left, right}) clustering.candidates[dead] = {};
  for (const int node : clustering.alive) {
    const int nearest = clustering.candidates[node].nearest;
    if (nearest == left || nearest == right) find_nearest(clustering, node);
  }
}

}  // namespace

BinaryTree build_light_tree(int leaf_count, const std::function<double(int, int)>& distance,
                            const std::function<void(int left, int right, int node)>& merge) {
  if (leaf_count < 0) throw std::invalid_argument("build_light_tree: a negative number of leaves");
  BinaryTree tree;
  tree.leaf_count = leaf_count;
  tree.nodes.resize(leaf_count);
  Clustering clustering;
  for (int leaf = 0; leaf < leaf_count; ++leaf) add_node(clustering, leaf, distance);
  while (clustering.alive.size() > 1) {
    const int right = closest_node(clustering), left = clustering.candidates[right].nearest;
    const int node = int(tree.nodes.size());
    tree.nodes.push_back({left, right, clustering.nearest_distance(right)});
    merge(left, right, node);
    retire(clustering, left, right);
    add_node(clustering, node, distance);
  }
  return tree;
}

}  // namespace chiaro::inverse::numerics
