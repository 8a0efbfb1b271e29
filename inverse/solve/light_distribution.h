#pragma once
// Where light comes from: two rounds of spreading unity lights, solving for their intensities, deleting the weak ones.

#include <array>

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

struct DistributionRound {
  std::size_t spread = 0, lit = 0, kept = 0;  // unity lights; with an intensity > 0; left after deleting
  double kkt_residual = 0;
  double relative_error = 0;  // of the kept lights, (3.6)
  LightEstimates lights;      // the kept ones
};

struct LightDistribution {
  std::array<DistributionRound, 2> rounds;
  // The lattice of the second round, and for each of its lights the node.
  std::array<int, 3> lattice_counts{};
  std::vector<std::size_t> nodes;  // of rounds[1].lights
  std::vector<Column> columns;     // of rounds[1].lights
};

// weak_light: w of eq. (3.5); a light is deleted if ‖l φ‖ < w ‖Ψ‖. The first round takes the lights at the
// grid's nodes, or where these are more than a thousand those at every second, fourth … of each axis; the second a lattice twice as fine around the survivors.
LightDistribution estimate_light_distribution(const LightResponse& response, const Observations& observations,
                                              double weak_light);

}  // namespace chiaro::inverse
