#pragma once
// Between the lights of a grid: trilinear in its cells, and in finer cells where it has them.
//
//   w_j = v_j Π_a max(0, 1 − |x_a − p_ja| / h_a) / Σ of the same,  over the lights j that see x
//
//   h    size of the cell that x is in
//   v_j  volume of light j's cell
//
// Where cells of one size meet cells of another, weights jump.

#include <Eigen/Core>
#include <vector>

#include "inverse/transport/light_grid.h"

namespace chiaro::inverse {

struct GridWeight {
  std::size_t light;
  double value;
  Eigen::Vector3d gradient;  // by the position, per metre
};

class GridInterpolation {
 public:
  // Keeps references to both.
  GridInterpolation(const renderer::RayTracer& tracer, const LightGrid& grid);

  // Adding up to 1. Positions outside the region take the nearest point of its border. Where no light of the cells
  // around sees the position, the nearest of all stands for them.
  std::vector<GridWeight> weights(const Eigen::Vector3d& position) const;

 private:
  struct Neighbour {
    std::size_t light;
    int level;
  };
  int level_at(std::size_t node, const Eigen::Vector3d& position) const;
  std::size_t nearest_light(const Eigen::Vector3d& position) const;

  const renderer::RayTracer& tracer_;
  const LightGrid& grid_;
  std::vector<std::vector<Neighbour>> lights_of_cell_;  // by node: its own light, or those of its finer cells
};

}  // namespace chiaro::inverse
