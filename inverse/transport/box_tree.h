#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::inverse {

// A binary tree of bounding boxes over items that the caller keeps, to find those near a point in logarithmic time.
struct BoxTree {
  struct Node {
    renderer::Box3f box;
    std::uint32_t first = 0;  // of a leaf: in items; of an inner node: its children are nodes first and first + 1
    std::uint32_t count = 0;  // items of a leaf; 0: an inner node
  };
  std::vector<Node> nodes;           // the root first; none without items
  std::vector<std::uint32_t> items;  // indices into `boxes`
};

// Split at the median of the longest side of the boxes' centres. A function of `boxes` alone.
BoxTree make_box_tree(std::span<const renderer::Box3f> boxes);

// Calls visit(item) for every item of the leaves whose boxes lie within `reach` metres of `point`, near boxes first.
// visit returns the reach from there on: the same, or less once something near is found.
void visit_near(const BoxTree& tree, renderer::Vec3f point, double reach,
                const std::function<double(std::uint32_t item)>& visit);

// Calls visit(item) for every item of the leaves whose boxes overlap `box`.
void visit_overlapping(const BoxTree& tree, const renderer::Box3f& box,
                       const std::function<void(std::uint32_t item)>& visit);

}  // namespace chiaro::inverse
