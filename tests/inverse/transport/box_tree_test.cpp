#include "inverse/transport/box_tree.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

using renderer::Box3f;
using renderer::Vec3f;

std::vector<Vec3f> random_points(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  std::vector<Vec3f> points(count);
  for (Vec3f& point : points) point = {coordinate(random), 0.1F * coordinate(random), coordinate(random)};
  return points;
}

BoxTree tree_of(const std::vector<Vec3f>& points) {
  std::vector<Box3f> boxes;
  for (const Vec3f point : points) boxes.push_back({point, point});
  return make_box_tree(boxes);
}

TEST(BoxTree, FindsTheNearestPointThatASearchOfAllFinds) {
  const std::vector<Vec3f> points = random_points(1000);
  const BoxTree tree = tree_of(points);
  for (const Vec3f query : random_points(200)) {
    const Vec3f from = 3 * query;
    double nearest = 1e9;
    std::size_t visited = 0;
    visit_near(tree, from, nearest, [&](std::uint32_t i) {
      ++visited;
      return nearest = std::min(nearest, double(length(points[i] - from)));
    });
    double expected = 1e9;
    for (const Vec3f point : points) expected = std::min(expected, double(length(point - from)));
    EXPECT_EQ(nearest, expected);
    EXPECT_LT(visited, points.size() / 2);
  }
}

TEST(BoxTree, VisitsEveryItemWithinReachOnce) {
  const std::vector<Vec3f> points = random_points(1000);
  std::vector<int> visits(points.size());
  visit_near(tree_of(points), {0.1F, 0, 0.2F}, 0.5, [&](std::uint32_t i) {
    ++visits[i];
    return 0.5;
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool within = length(points[i] - Vec3f{0.1F, 0, 0.2F}) < 0.4999F;
    EXPECT_GE(visits[i], within ? 1 : 0) << i;
    EXPECT_LE(visits[i], 1) << i;
  }
}

TEST(BoxTree, HoldsPointsThatAllCoincide) {
  const BoxTree tree = tree_of(std::vector<Vec3f>(100, {1, 2, 3}));
  int visits = 0;
  visit_near(tree, {1, 2, 3}, 0, [&](std::uint32_t) { return ++visits, 0.0; });
  EXPECT_EQ(visits, 100);
}

TEST(BoxTree, WithoutItemsVisitsNothing) {
  visit_near(make_box_tree({}), {}, 1e9, [](std::uint32_t) -> double {
    ADD_FAILURE();
    return 0;
  });
}

}  // namespace
}  // namespace chiaro::inverse
