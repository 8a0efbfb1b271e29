#include "inverse/transport/grid_interpolation.h"

#include <gtest/gtest.h>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/sampler.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::Material;
using renderer::RayTracer;
using renderer::Scene;

const Box3f kRegion{{0.5F, 0.5F, 0.5F}, {3.5F, 2.5F, 3.5F}};

Scene room_with_board() {
  Scene scene;
  test::add_mesh(scene, test::room({4, 3, 4}, 2), test::lambert({0.5F, 0.5F, 0.5F}), "room");
  // Across the room, from wall to wall, between two layers of nodes.
  Material both = test::lambert({0.5F, 0.5F, 0.5F});
  both.double_sided = true;
  test::add_mesh(scene, test::rectangle({0, 1.63F, 0}, {0, 0, 4}, {4, 0, 0}), both, "board");
  return scene;
}

Scene empty_room() {
  Scene scene;
  test::add_mesh(scene, test::room({4, 3, 4}, 2), test::lambert({0.5F, 0.5F, 0.5F}), "room");
  return scene;
}

// The halves of two neighbouring cells, and of one of these halves.
LightGrid grid_with_finer_cells(const RayTracer& tracer) {
  LightGrid grid = make_light_grid(tracer, {.counts = {6, 4, 6}, .region = kRegion});
  std::vector<LightGrid::FinerCell> cells;
  const auto add_halves = [&](const GridCell& cell, bool all) {
    for (std::uint32_t k = all ? 0 : 1; k < 8; ++k) {
      const GridCell half{cell.level + 1,
                          {2 * cell.at[0] + (k & 1), 2 * cell.at[1] + (k >> 1 & 1), 2 * cell.at[2] + (k >> 2)}};
      cells.push_back({half.level, number_of(grid, half)});
    }
  };
  add_halves({0, {2, 1, 2}}, false);
  add_halves({1, {4, 2, 4}}, true);
  add_halves({0, {3, 1, 2}}, true);
  std::sort(cells.begin(), cells.end());
  set_finer_cells(grid, cells);
  return grid;
}

Vector3d random_position(std::uint32_t number, const Box3f& box) {
  renderer::Sampler sampler(7, number, 0);
  const renderer::Vec2f xy = sampler.next_2d();
  return to_eigen(box.min + box.extent() * Vec3f{xy.x, xy.y, sampler.next_1d()});
}

double sum_of(const std::vector<GridWeight>& weights) {
  double sum = 0;
  for (const GridWeight& w : weights) sum += w.value;
  return sum;
}

TEST(GridInterpolation, FinerCellsAreWhereTheirNumbersSay) {
  const Scene scene = empty_room();
  const RayTracer tracer(scene);
  const LightGrid grid = grid_with_finer_cells(tracer);
  EXPECT_EQ(grid.node_light_count(), 144U);
  ASSERT_EQ(grid.finer.size(), 23U);
  for (std::size_t k = 0; k < grid.finer.size(); ++k) {
    const GridCell cell = cell_of(grid, grid.finer[k]);
    EXPECT_EQ(number_of(grid, cell), grid.finer[k].number);
    EXPECT_TRUE(bounds_of(grid, cell).contains(grid.positions[144 + k]));
    const std::size_t node = node_of(grid, cell);
    const Vec3f offset = grid.positions[144 + k] - grid.positions[std::size_t(grid.light_of_node[node])];
    for (int a = 0; a < 3; ++a) EXPECT_LT(std::abs(offset[a]), 0.5F * grid.spacing[a]);
  }
}

TEST(GridInterpolation, WeightsAddUpToOneAndTheirGradientsToZero) {
  const Scene scene = empty_room();
  const RayTracer tracer(scene);
  const LightGrid grid = grid_with_finer_cells(tracer);
  const GridInterpolation interpolation(tracer, grid);
  for (std::uint32_t k = 0; k < 500; ++k) {
    const auto weights = interpolation.weights(random_position(k, {{0, 0, 0}, {4, 3, 4}}));
    EXPECT_NEAR(sum_of(weights), 1, 1e-12);
    Vector3d gradient = Vector3d::Zero();
    for (const GridWeight& w : weights) gradient += w.gradient;
    EXPECT_LT(gradient.norm(), 1e-9);
  }
}

TEST(GridInterpolation, AtALightOfTheFinestCellsItHasThatLightAlone) {
  const Scene scene = empty_room();
  const RayTracer tracer(scene);
  const LightGrid grid = grid_with_finer_cells(tracer);
  const GridInterpolation interpolation(tracer, grid);
  for (std::size_t k = 0; k < grid.finer.size(); ++k) {
    if (grid.finer[k].level < 2) continue;
    for (const GridWeight& w : interpolation.weights(to_eigen(grid.positions[144 + k]))) {
      EXPECT_NEAR(w.value, w.light == 144 + k ? 1 : 0, 1e-5);
    }
  }
}

TEST(GridInterpolation, GradientsEqualCentralDifferences) {
  const Scene scene = empty_room();
  const RayTracer tracer(scene);
  const LightGrid grid = grid_with_finer_cells(tracer);
  const GridInterpolation interpolation(tracer, grid);
  // A smooth function of the lights' positions.
  const auto at = [&](const Vector3d& x) {
    double sum = 0;
    for (const GridWeight& w : interpolation.weights(x))
      sum += w.value * double(length_squared(grid.positions[w.light]));
    return sum;
  };
  constexpr double kStep = 1e-5;
  const Box3f finer = bounds_of(grid, {0, {3, 1, 2}});
  for (std::uint32_t k = 0; k < 100; ++k) {
    const Vector3d x = random_position(k, finer);
    Vector3d gradient = Vector3d::Zero();
    for (const GridWeight& w : interpolation.weights(x)) {
      gradient += double(length_squared(grid.positions[w.light])) * w.gradient;
    }
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = kStep * Vector3d::Unit(a);
      EXPECT_NEAR(gradient[a], (at(x + step) - at(x - step)) / (2 * kStep), 1e-4 * gradient.norm()) << k << " " << a;
    }
  }
}

TEST(GridInterpolation, NothingComesThroughABoard) {
  const Scene scene = room_with_board();
  const RayTracer tracer(scene);
  const LightGrid grid = make_light_grid(tracer, {.counts = {6, 4, 6}, .region = kRegion});
  const GridInterpolation interpolation(tracer, grid);
  for (std::uint32_t k = 0; k < 300; ++k) {
    const Vector3d x = random_position(k, {{0.6F, 1.3F, 0.6F}, {3.4F, 2, 3.4F}});
    if (x.y() > 1.6 && x.y() < 1.66) continue;
    for (const GridWeight& w : interpolation.weights(x)) {
      EXPECT_EQ(grid.positions[w.light].y > 1.63F, x.y() > 1.63) << x.transpose();
    }
  }
}

}  // namespace
}  // namespace chiaro::inverse
