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
GridCell cell_at(const LightGrid& grid, const Vector3d& position) {
  GridCell cell;
  for (int a = 0; a < 3; ++a) {
    const auto spacing = double(grid.spacing[a]);
    const double at = spacing > 0 ? (position[a] - double(grid.region.min[a])) / spacing : 0;
    cell.at[a] = std::uint32_t(std::clamp(int(at), 0, grid.counts[a] - 1));
  }
  return cell;
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
    : tracer_(tracer), grid_(grid), lights_of_cell_(grid.light_of_node.size()) {
  for (std::size_t k = 0; k < grid.finer.size(); ++k) {
    const GridCell cell = cell_of(grid, grid.finer[k]);
    lights_of_cell_[node_of(grid, cell)].push_back({grid.node_light_count() + k, cell.level});
  }
  for (std::size_t node = 0; node < lights_of_cell_.size(); ++node) {
    const bool whole = lights_of_cell_[node].empty() && grid.light_of_node[node] >= 0;
    if (whole) lights_of_cell_[node] = {{std::size_t(grid.light_of_node[node]), 0}};
  }
}

int GridInterpolation::level_at(std::size_t node, const Vector3d& position) const {
  int level = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Neighbour& light : lights_of_cell_[node]) {
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
  const GridCell cell = cell_at(grid_, x);
  const Vector3d width = to_eigen(grid_.spacing) / double(1 << level_at(node_of(grid_, cell), x));
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
  std::array<std::uint32_t, 3> low{}, high{};  // of the cells around
  for (int a = 0; a < 3; ++a) {
    low[a] = cell.at[a] - (cell.at[a] > 0 ? 1 : 0);
    high[a] = std::min(cell.at[a] + 1, std::uint32_t(grid_.counts[a] - 1));
  }
  for (std::uint32_t z = low[2]; z <= high[2]; ++z) {
    for (std::uint32_t y = low[1]; y <= high[1]; ++y) {
      for (std::uint32_t i = low[0]; i <= high[0]; ++i) {
        for (const Neighbour& light : lights_of_cell_[node_of(grid_, {0, {i, y, z}})]) add(light);
      }
    }
  }
  if (total < kLeastWeight) return {{nearest_light(x), 1, Vector3d::Zero()}};
  normalise(weights);
  return weights;
}

}  // namespace chiaro::inverse
