#include "inverse/transport/grid_interpolation.h"

#include <algorithm>
#include <limits>

#include "inverse/transport/eigen_vectors.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;

constexpr double kLeastWeight = 1e-6;

// Along one axis.
struct Hat {
  double value = 1, slope = 0;
};

Hat hat(double offset, double width) {
  if (!(width > 0)) return {};  // the region is flat
  const double t = std::abs(offset) / width;
  if (t >= 1) return {0, 0};
  return {1 - t, (offset > 0 ? -1 : 1) / width};
}

Vector3d into_region(const Box3f& region, const Vector3d& position) {
  return position.cwiseMax(to_eigen(region.min)).cwiseMin(to_eigen(region.max));
}

// The whole cell that a position is in.
std::array<int, 3> cell_at(const LightGrid& grid, const Vector3d& position) {
  std::array<int, 3> cell{};
  for (int a = 0; a < 3; ++a) {
    const auto spacing = double(grid.spacing[a]);
    const double at = spacing > 0 ? (position[a] - double(grid.region.min[a])) / spacing : 0;
    cell[a] = std::clamp(int(at), 0, grid.counts[a] - 1);
  }
  return cell;
}

std::size_t node_at(const LightGrid& grid, const std::array<int, 3>& cell) {
  return std::size_t(cell[0]) +
         std::size_t(grid.counts[0]) * (std::size_t(cell[1]) + std::size_t(grid.counts[1]) * std::size_t(cell[2]));
}

void normalise(std::vector<GridWeight>& weights) {
  double total = 0;
  Vector3d total_gradient = Vector3d::Zero();
  for (const GridWeight& w : weights) total += w.value, total_gradient += w.gradient;
  for (GridWeight& w : weights) {
    w.gradient = (w.gradient - (w.value / total) * total_gradient) / total;
    w.value /= total;
  }
}

}  // namespace

GridInterpolation::GridInterpolation(const renderer::RayTracer& tracer, const LightGrid& grid)
    : tracer_(tracer), grid_(grid), finer_of_node_(grid.finer.empty() ? 0 : grid.light_of_node.size()) {
  for (std::size_t k = 0; k < grid.finer.size(); ++k) {
    const GridCell cell = cell_of(grid, grid.finer[k]);
    finer_of_node_[node_of(grid, cell)].push_back({grid.node_light_count() + k, cell.level});
  }
}

std::vector<GridInterpolation::Neighbour> GridInterpolation::lights_of_cell(std::size_t node) const {
  if (!finer_of_node_.empty() && !finer_of_node_[node].empty()) return finer_of_node_[node];
  if (grid_.light_of_node[node] < 0) return {};
  return {{std::size_t(grid_.light_of_node[node]), 0}};
}

int GridInterpolation::level_at(std::size_t node, const Vector3d& position) const {
  int level = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Neighbour& light : lights_of_cell(node)) {
    const Vector3d offset = position - to_eigen(grid_.positions[light.light]);
    double distance = 0;  // in cells
    for (int a = 0; a < 3; ++a) {
      if (grid_.spacing[a] > 0) distance = std::max(distance, std::abs(offset[a]) / double(grid_.spacing[a]));
    }
    distance *= double(1 << light.level);
    if (distance < least) least = distance, level = light.level;
  }
  return level;
}

std::size_t GridInterpolation::nearest_light(const Vector3d& position) const {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < grid_.positions.size(); ++j) {
    const double d = (to_eigen(grid_.positions[j]) - position).squaredNorm();
    if (d < least) least = d, nearest = j;
  }
  return nearest;
}

std::vector<GridWeight> GridInterpolation::weights(const Vector3d& position) const {
  const Vector3d x = into_region(grid_.region, position);
  const std::array<int, 3> cell = cell_at(grid_, x);
  const Vector3d width = to_eigen(grid_.spacing) / double(1 << level_at(node_at(grid_, cell), x));
  std::vector<GridWeight> weights;
  double total = 0;
  const auto add = [&](const Neighbour& light) {
    const Vec3f from = grid_.positions[light.light];
    const Vector3d offset = x - to_eigen(from);
    const Hat along[3] = {hat(offset[0], width[0]), hat(offset[1], width[1]), hat(offset[2], width[2])};
    const double value = along[0].value * along[1].value * along[2].value;
    if (!(value > 0) || tracer_.occluded_between(from, to_vec3f(x), 0)) return;
    const double volume = 1 / double(1 << (3 * light.level));
    Vector3d gradient{along[0].slope * along[1].value * along[2].value,
                      along[0].value * along[1].slope * along[2].value,
                      along[0].value * along[1].value * along[2].slope};
    for (int a = 0; a < 3; ++a) {
      if (x[a] != position[a]) gradient[a] = 0;
    }
    weights.push_back({light.light, volume * value, volume * gradient});
    total += weights.back().value;
  };
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const std::array<int, 3> at{cell[0] + dx, cell[1] + dy, cell[2] + dz};
        bool inside = true;
        for (int a = 0; a < 3; ++a) inside = inside && at[a] >= 0 && at[a] < grid_.counts[a];
        if (!inside) continue;
        for (const Neighbour& light : lights_of_cell(node_at(grid_, at))) add(light);
      }
    }
  }
  if (total < kLeastWeight) return {{nearest_light(x), 1, Vector3d::Zero()}};
  normalise(weights);
  return weights;
}

}  // namespace chiaro::inverse
