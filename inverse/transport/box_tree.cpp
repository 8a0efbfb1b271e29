#include "inverse/transport/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace chiaro::inverse {
namespace {

using renderer::Box3f;
using renderer::Vec3f;

constexpr std::uint32_t kLeafSize = 4;

struct Builder {
  std::span<const Box3f> boxes;
  BoxTree tree;

  void fill(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    Box3f box, centers;
    for (std::uint32_t i = first; i < first + count; ++i) {
      const Box3f& item = boxes[tree.items[i]];
      box.extend(item.min);
      box.extend(item.max);
      centers.extend(item.center());
    }
    tree.nodes[node] = {box, first, count};
    if (count > kLeafSize) split(node, longest_side(centers));
  }

  void split(std::uint32_t node, int axis) {
    const auto [first, count] = std::pair(tree.nodes[node].first, tree.nodes[node].count);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(boxes[a].center()[axis], a) < std::pair(boxes[b].center()[axis], b);
    };
    const auto begin = tree.items.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, before);
    const auto children = std::uint32_t(tree.nodes.size());
    tree.nodes[node].first = children;
    tree.nodes[node].count = 0;
    tree.nodes.resize(children + 2);
    fill(children, first, count / 2);
    fill(children + 1, first + count / 2, count - count / 2);
  }

  static int longest_side(const Box3f& box) {
    const Vec3f extent = box.extent();
    return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  }
};

double distance(const Box3f& box, Vec3f point) {
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double p = point[axis];
    const double outside = std::max({box.min[axis] - p, 0.0, p - box.max[axis]});
    squared += outside * outside;
  }
  return std::sqrt(squared);
}

bool overlap(const Box3f& a, const Box3f& b) { return min_component(min(a.max, b.max) - max(a.min, b.min)) >= 0; }

struct Visitor {
  const BoxTree& tree;
  Vec3f point;
  double reach;
  const std::function<double(std::uint32_t)>& visit;

  void enter(std::uint32_t index) {
    const BoxTree::Node& node = tree.nodes[index];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) reach = visit(tree.items[i]);
    if (node.count > 0) return;
    std::pair<double, std::uint32_t> near{distance(tree.nodes[node.first].box, point), node.first};
    std::pair<double, std::uint32_t> far{distance(tree.nodes[node.first + 1].box, point), node.first + 1};
    if (far < near) std::swap(near, far);
    if (near.first <= reach) enter(near.second);
    if (far.first <= reach) enter(far.second);
  }
};

}  // namespace

BoxTree make_box_tree(std::span<const Box3f> boxes) {
  Builder builder{boxes, {}};
  if (boxes.empty()) return {};
  builder.tree.items.resize(boxes.size());
  std::iota(builder.tree.items.begin(), builder.tree.items.end(), 0U);
  builder.tree.nodes.resize(1);
  builder.fill(0, 0, std::uint32_t(boxes.size()));
  return std::move(builder.tree);
}

void visit_near(const BoxTree& tree, Vec3f point, double reach,
                const std::function<double(std::uint32_t item)>& visit) {
  if (!tree.nodes.empty() && distance(tree.nodes[0].box, point) <= reach) Visitor{tree, point, reach, visit}.enter(0);
}

void visit_overlapping(const BoxTree& tree, const Box3f& box, const std::function<void(std::uint32_t item)>& visit) {
  std::vector<std::uint32_t> open;
  if (!tree.nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const BoxTree::Node& node = tree.nodes[open.back()];
    open.pop_back();
    if (!overlap(node.box, box)) continue;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(tree.items[i]);
    if (node.count == 0) open.insert(open.end(), {node.first, node.first + 1});
  }
}

}  // namespace chiaro::inverse
