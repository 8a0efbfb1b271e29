#pragma once

#include <functional>
#include <vector>

namespace chiaro::inverse::numerics {

// A binary tree over k leaves: nodes 0 … k−1 are the leaves, then the merged nodes in the order of merging; the last
// node is the root.
struct BinaryTree {
  struct Node {
    int left = -1, right = -1;  // -1: a leaf
    double distance = 0;        // between left and right when they were merged
  };
  std::vector<Node> nodes;
  int leaf_count = 0;
  int root() const { return int(nodes.size()) - 1; }
  bool is_leaf(int node) const { return nodes[node].left < 0; }
};

// Greedy bottom-up clustering: the closest pair is merged first (ties: the lowest indices).
// distance(a, b): symmetric, ≥ 0, asked for once per pair of nodes alive together. merge(left, right, node): called
// when `node` comes into being, so that the caller can make its representative before distances to it are asked for.
BinaryTree build_light_tree(int leaf_count, const std::function<double(int, int)>& distance,
                            const std::function<void(int left, int right, int node)>& merge);

}  // namespace chiaro::inverse::numerics
