// A cut through the light tree, refined from the root.
// Source: B. Walter, S. Fernandez, A. Arbree, K. Bala, M. Donikian, D. Greenberg, Lightcuts: A Scalable Approach to
// Illumination, 2005, section 3.2; thesis section 3.4.2. There the node with the largest bound is refined; here the
// errors of all refinements are known, and the best is taken.

#include "inverse/numerics/lightcut.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace chiaro::inverse::numerics {
namespace {

using CutError = std::function<double(const std::vector<int>& cut)>;

struct Refinement {
  std::vector<int> nodes;
  double error = 0;
};

double finite_or_infinite(double error) { return std::isnan(error) ? std::numeric_limits<double>::infinity() : error; }

std::vector<int> refined(const std::vector<int>& cut, int node, const BinaryTree& tree) {
  std::vector<int> nodes = cut;
  std::erase(nodes, node);
  nodes.push_back(tree.nodes[node].left);
  nodes.push_back(tree.nodes[node].right);
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

// Ties: the lowest node is replaced. Nothing where all are leaves.
std::optional<Refinement> best_refinement(const std::vector<int>& cut, const BinaryTree& tree, const CutError& error) {
  std::optional<Refinement> best;
  for (const int node : cut) {
    if (tree.is_leaf(node)) continue;
    Refinement candidate{refined(cut, node, tree), 0};
    candidate.error = finite_or_infinite(error(candidate.nodes));
    if (!best || candidate.error < best->error) best = std::move(candidate);
  }
  return best;
}

bool wants_more(const Lightcut& cut, const LightcutOptions& options) {
  const auto size = std::ptrdiff_t(cut.nodes.size());
  return size < options.max_size && (size < options.min_size || !(cut.error <= options.error_threshold));
}

}  // namespace

Lightcut choose_lightcut(const BinaryTree& tree, const CutError& error, const LightcutOptions& options) {
  Lightcut cut;
  if (!tree.nodes.empty()) cut.nodes = {tree.root()};
  cut.error = finite_or_infinite(error(cut.nodes));
  if (cut.nodes.empty()) return cut;
  cut.error_curve = {cut.error};
  while (wants_more(cut, options)) {
    std::optional<Refinement> next = best_refinement(cut.nodes, tree, error);
    if (!next) break;
    cut.nodes = std::move(next->nodes);
    cut.error = next->error;
    cut.error_curve.push_back(cut.error);
  }
  return cut;
}

}  // namespace chiaro::inverse::numerics
