#include "inverse/numerics/light_tree.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

namespace chiaro::inverse::numerics {
namespace {

// Points on a line; a merged node stands in the middle of its children. Notes what was asked, and when.
struct Line {
  std::vector<double> positions;
  std::set<std::pair<int, int>> asked = {};
  int repeats = 0;
  int too_early = 0;

  double distance(int a, int b) {
    if (std::max(a, b) >= int(positions.size())) return ++too_early;
    repeats += asked.insert(std::minmax(a, b)).second ? 0 : 1;
    return std::abs(positions[a] - positions[b]);
  }
  BinaryTree build() {
    return build_light_tree(
        int(positions.size()), [&](int a, int b) { return distance(a, b); },
        [&](int left, int right, int node) {
          if (node != int(positions.size())) ++too_early;
          positions.push_back(0.5 * (positions[left] + positions[right]));
        });
  }
};

std::vector<std::pair<int, int>> merges(const BinaryTree& tree) {
  std::vector<std::pair<int, int>> pairs;
  for (int node = tree.leaf_count; node < int(tree.nodes.size()); ++node) {
    pairs.emplace_back(tree.nodes[node].left, tree.nodes[node].right);
  }
  return pairs;
}

using Pairs = std::vector<std::pair<int, int>>;

// All pairs looked at in every round.
Pairs naive_merges(std::vector<double> positions) {
  Pairs pairs;
  std::set<int> alive;
  for (int i = 0; i < int(positions.size()); ++i) alive.insert(i);
  while (alive.size() > 1) {
    std::pair<int, int> best{-1, -1};
    double lowest = std::numeric_limits<double>::infinity();
    for (const int a : alive) {
      for (const int b : alive) {
        const double distance = std::abs(positions[a] - positions[b]);
        if (a < b && distance < lowest) best = {a, b}, lowest = distance;
      }
    }
    pairs.push_back(best);
    alive.erase(best.first);
    alive.erase(best.second);
    alive.insert(int(positions.size()));
    positions.push_back(0.5 * (positions[best.first] + positions[best.second]));
  }
  return pairs;
}

TEST(LightTree, MergesTheClosestPairFirst) {
  Line line{{0, 10, 1, 13}};
  const BinaryTree tree = line.build();
  EXPECT_EQ(tree.leaf_count, 4);
  EXPECT_EQ(merges(tree), (Pairs{{0, 2}, {1, 3}, {4, 5}}));
  EXPECT_DOUBLE_EQ(tree.nodes[4].distance, 1);
  EXPECT_DOUBLE_EQ(tree.nodes[5].distance, 3);
  EXPECT_DOUBLE_EQ(tree.nodes[6].distance, 11);
  EXPECT_EQ(tree.root(), 6);
  EXPECT_TRUE(tree.is_leaf(3));
  EXPECT_FALSE(tree.is_leaf(4));
}

TEST(LightTree, AMergedNodeCompetesWithTheLeaves) {
  Line line{{0, 1, 2.2, 50}};  // 0 and 1 to 0.5, which is nearer to 2.2 than any other pair
  EXPECT_EQ(merges(line.build()), (Pairs{{0, 1}, {2, 4}, {3, 5}}));
}

TEST(LightTree, TiesGoToTheLowestIndices) {
  EXPECT_EQ(merges(Line{{0, 1, 2, 3}}.build()), (Pairs{{0, 1}, {2, 3}, {4, 5}}));
  EXPECT_EQ(merges(Line{{7, 7, 7}}.build()), (Pairs{{0, 1}, {2, 3}}));
  EXPECT_EQ(merges(Line{{2, 9, 8, 1}}.build()), (Pairs{{0, 3}, {1, 2}, {4, 5}}));
}

TEST(LightTree, EqualsTheNaiveClustering) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    std::vector<double> positions(2 + seed);
    for (double& p : positions) p = std::uniform_int_distribution<int>(0, seed % 2 ? 20 : 1000000)(random);
    EXPECT_EQ(merges(Line{positions}.build()), naive_merges(positions)) << "seed " << seed;
  }
}

TEST(LightTree, AsksForEveryPairAliveTogetherOnce) {
  Line line{{4, 8, 15, 16, 23, 42}};
  line.build();
  EXPECT_EQ(line.repeats, 0);
  EXPECT_EQ(line.too_early, 0);
  EXPECT_EQ(line.asked.size(), 15U + 4 + 3 + 2 + 1);
}

TEST(LightTree, OneLeafAndNone) {
  const BinaryTree one = Line{{3}}.build(), none = Line{{}}.build();
  EXPECT_EQ(one.nodes.size(), 1U);
  EXPECT_EQ(one.root(), 0);
  EXPECT_TRUE(one.is_leaf(0));
  EXPECT_TRUE(none.nodes.empty());
  EXPECT_EQ(none.root(), -1);
  EXPECT_THROW(build_light_tree(-1, {}, {}), std::invalid_argument);
}

TEST(LightTree, DistancesThatAreNotNumbersComeLast) {
  const BinaryTree tree = build_light_tree(
      3, [](int a, int b) { return a == 1 && b == 2 ? 5.0 : NAN; }, [](int, int, int) {});
  EXPECT_EQ(merges(tree), (Pairs{{1, 2}, {0, 3}}));
}

}  // namespace
}  // namespace chiaro::inverse::numerics
