// Chen, Lighting Design with Illumination Brush, 2008, section 3.3.1.

#include "inverse/solve/light_distribution.h"

#include <algorithm>
#include <set>

namespace chiaro::inverse {
namespace {

constexpr std::size_t kMostCoarseLights = 1000;

struct UnityLights {
  std::vector<std::size_t> nodes;  // on their lattice
  LightEstimates lights;
  std::vector<Column> columns;
};

std::array<std::size_t, 3> coordinates(std::size_t node, const std::array<int, 3>& counts) {
  const auto nx = std::size_t(counts[0]), ny = std::size_t(counts[1]);
  return {node % nx, node / nx % ny, node / (nx * ny)};
}

std::size_t node_at(const std::array<std::size_t, 3>& c, const std::array<int, 3>& counts) {
  return c[0] + std::size_t(counts[0]) * (c[1] + std::size_t(counts[1]) * c[2]);
}

// Fine nodes stand in the middle of the grid's cells, on their faces and on the region's border: fine node 2 i + 1 is
// coarse node i. An axis along which the region is flat has one.
int fine_count(const LightGrid& grid, int axis) { return grid.spacing[axis] > 0 ? 2 * grid.counts[axis] + 1 : 1; }

long fine_of(std::size_t coarse, int step, int fine_nodes) {
  return fine_nodes == 1 ? step : 2 * long(coarse) + 1 + step;
}

Eigen::Vector3d fine_position(const LightGrid& grid, const std::array<std::size_t, 3>& fine) {
  Eigen::Vector3d p;
  for (int a = 0; a < 3; ++a) p[a] = double(grid.region.min[a]) + 0.5 * double(fine[a]) * double(grid.spacing[a]);
  return p;
}

std::size_t coarse_stride(const LightGrid& grid) {
  std::size_t stride = 1;
  while (grid.node_light_count() / (stride * stride * stride) > kMostCoarseLights) stride *= 2;
  return stride;
}

// Of every `stride`-th node along each axis.
UnityLights spread_coarsely(const LightResponse& response, std::size_t stride) {
  const LightGrid& grid = response.grid();
  std::vector<char> allowed(grid.positions.size(), 0);
  for (const std::size_t light : response.grid_lights_near_places()) allowed[light] = 1;
  UnityLights spread;
  for (std::size_t node = 0; node < grid.light_of_node.size(); ++node) {
    const auto c = coordinates(node, grid.counts);
    const bool taken = c[0] % stride == 0 && c[1] % stride == 0 && c[2] % stride == 0;
    if (!taken || grid.light_of_node[node] < 0) continue;
    const auto light = std::size_t(grid.light_of_node[node]);
    if (allowed[light] == 0) continue;
    spread.nodes.push_back(node);
    const Vec3f p = grid.positions[light];
    spread.lights.push_back({{p.x, p.y, p.z}, Eigen::Array3d::Ones()});
    spread.columns.push_back(response.grid_column(light));
  }
  return spread;
}

// The lattice has twice the grid's density; nodes are taken around each survivor, half way to the next coarse ones.
UnityLights spread_finely(const LightResponse& response, const UnityLights& survivors, std::size_t stride,
                          const std::array<int, 3>& lattice) {
  const LightGrid& grid = response.grid();
  const auto reach = int(stride);
  std::set<std::size_t> nodes;
  for (const std::size_t survivor : survivors.nodes) {
    const auto c = coordinates(survivor, grid.counts);
    for (int dz = -reach; dz <= reach; ++dz) {
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          const std::array<long, 3> fine{fine_of(c[0], dx, lattice[0]), fine_of(c[1], dy, lattice[1]),
                                         fine_of(c[2], dz, lattice[2])};
          bool inside = true;
          for (int a = 0; a < 3; ++a) inside = inside && fine[a] >= 0 && fine[a] < lattice[a];
          if (inside)
            nodes.insert(node_at({std::size_t(fine[0]), std::size_t(fine[1]), std::size_t(fine[2])}, lattice));
        }
      }
    }
  }
  UnityLights spread;
  for (const std::size_t node : nodes) {
    spread.nodes.push_back(node);
    spread.lights.push_back({fine_position(grid, coordinates(node, lattice)), Eigen::Array3d::Ones()});
  }
  spread.columns = evaluate_columns(response, spread.lights, Evaluation::kTracedVisibility);
  return spread;
}

// Solves for the intensities and deletes the weak (3.5).
DistributionRound solve_and_delete(const Observations& observations, UnityLights& lights, double weak_light) {
  DistributionRound round;
  round.spread = lights.lights.size();
  const IntensityFit fit = fit_intensities(observations, lights.columns);
  round.kkt_residual = fit.kkt_residual;
  std::vector<double> contribution;
  for (std::size_t j = 0; j < lights.lights.size(); ++j) {
    contribution.push_back(contribution_norm(observations, lights.columns[j], fit.intensity[j]));
  }
  // The strongest stays even where all are weak.
  const double strongest = contribution.empty() ? 0 : *std::max_element(contribution.begin(), contribution.end());
  const double least = std::min(weak_light * observations.target_norm, strongest);
  UnityLights kept;
  for (std::size_t j = 0; j < lights.lights.size(); ++j) {
    if (!(contribution[j] > 0)) continue;
    ++round.lit;
    if (contribution[j] < least) continue;
    kept.nodes.push_back(lights.nodes[j]);
    kept.lights.push_back({lights.lights[j].position, fit.intensity[j]});
    kept.columns.push_back(std::move(lights.columns[j]));
  }
  lights = std::move(kept);
  round.kept = lights.lights.size();
  round.lights = lights.lights;
  round.relative_error =
      relative_error(observations, total_illumination(lights.columns, lights.lights, observations.wanted.rows()));
  return round;
}

}  // namespace

LightDistribution estimate_light_distribution(const LightResponse& response, const Observations& observations,
                                              double weak_light) {
  LightDistribution distribution;
  for (int a = 0; a < 3; ++a) distribution.lattice_counts[a] = fine_count(response.grid(), a);
  // Lights of a layer one node thick may be between the nodes that are taken.
  std::size_t stride = coarse_stride(response.grid());
  UnityLights lights = spread_coarsely(response, stride);
  while (lights.lights.empty() && stride > 1) lights = spread_coarsely(response, stride /= 2);
  distribution.rounds[0] = solve_and_delete(observations, lights, weak_light);
  lights = spread_finely(response, lights, stride, distribution.lattice_counts);
  distribution.rounds[1] = solve_and_delete(observations, lights, weak_light);
  distribution.nodes = std::move(lights.nodes);
  distribution.columns = std::move(lights.columns);
  return distribution;
}

}  // namespace chiaro::inverse
