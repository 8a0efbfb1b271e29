#include "inverse/numerics/lightcut.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace chiaro::inverse::numerics {
namespace {

// Leaves 0, 1, 2, 3 of worth 8, 1, 4, 2; 4 = {0, 1}, 5 = {2, 3}, 6 = the root.
BinaryTree make_tree() { return {{{}, {}, {}, {}, {0, 1, 1}, {2, 3, 2}, {4, 5, 3}}, 4}; }

// The error of a cut: what the inner nodes in it hide.
double hidden(const std::vector<int>& cut) {
  const double of_node[] = {0, 0, 0, 0, 0.9, 0.3, 2};
  double sum = 0;
  for (const int node : cut) sum += of_node[node];
  return sum;
}

TEST(Lightcut, StopsAtTheThreshold) {
  const Lightcut cut = choose_lightcut(make_tree(), hidden, {.error_threshold = 0.5});
  EXPECT_EQ(cut.nodes, (std::vector<int>{0, 1, 5}));  // 4 hides more than 5
  EXPECT_DOUBLE_EQ(cut.error, 0.3);
  ASSERT_EQ(cut.error_curve.size(), 3U);
  EXPECT_DOUBLE_EQ(cut.error_curve[0], 2);
  EXPECT_DOUBLE_EQ(cut.error_curve[1], 1.2);
  EXPECT_DOUBLE_EQ(cut.error_curve[2], 0.3);
}

TEST(Lightcut, AThresholdThatIsMetExactlyIsMet) {
  EXPECT_EQ(choose_lightcut(make_tree(), hidden, {.error_threshold = 2}).nodes, std::vector<int>{6});
}

TEST(Lightcut, RefinesToTheLeavesWhereNothingElseIsEnough) {
  const Lightcut cut = choose_lightcut(make_tree(), hidden, {.error_threshold = -1});
  EXPECT_EQ(cut.nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(cut.error_curve.size(), 4U);
  EXPECT_DOUBLE_EQ(cut.error, 0);
}

TEST(Lightcut, KeepsToTheSizesAskedFor) {
  const auto size = [](LightcutOptions options) { return choose_lightcut(make_tree(), hidden, options).nodes.size(); };
  EXPECT_EQ(size({.error_threshold = 10, .min_size = 3}), 3U);
  EXPECT_EQ(size({.error_threshold = 10, .min_size = 30}), 4U);
  EXPECT_EQ(size({.error_threshold = 0, .max_size = 2}), 2U);
  EXPECT_EQ(size({.error_threshold = 0, .min_size = 4, .max_size = 2}), 2U);
  EXPECT_EQ(size({.error_threshold = 0, .max_size = 0}), 1U);
}

TEST(Lightcut, TakesTheLeastRiseWhereAllRefinementsRaiseTheError) {
  const auto rising = [](const std::vector<int>& cut) { return double(cut.size()) - 0.5 * (cut.back() == 5 ? 1 : 0); };
  const Lightcut cut = choose_lightcut(make_tree(), rising, {.error_threshold = 0, .max_size = 3});
  EXPECT_EQ(cut.nodes, (std::vector<int>{0, 1, 5}));
  EXPECT_EQ(cut.error_curve, (std::vector<double>{1, 1.5, 2.5}));
}

TEST(Lightcut, TiesReplaceTheLowestNode) {
  const auto flat = [](const std::vector<int>&) { return 1.0; };
  EXPECT_EQ(choose_lightcut(make_tree(), flat, {.max_size = 3}).nodes, (std::vector<int>{0, 1, 5}));
}

TEST(Lightcut, OneLeafAndAnEmptyTree) {
  const auto one = [](const std::vector<int>& cut) { return cut.empty() ? 1.0 : 0.25; };
  const Lightcut leaf = choose_lightcut({{{}}, 1}, one, {});
  EXPECT_EQ(leaf.nodes, std::vector<int>{0});
  EXPECT_EQ(leaf.error_curve, std::vector<double>{0.25});
  const Lightcut none = choose_lightcut({}, one, {});
  EXPECT_TRUE(none.nodes.empty());
  EXPECT_TRUE(none.error_curve.empty());
  EXPECT_EQ(none.error, 1.0);
}

TEST(Lightcut, AnErrorThatIsNotANumberIsNeverEnough) {
  const auto broken = [](const std::vector<int>& cut) { return cut.size() < 4 ? NAN : 0.0; };
  EXPECT_EQ(choose_lightcut(make_tree(), broken, {}).nodes.size(), 4U);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
