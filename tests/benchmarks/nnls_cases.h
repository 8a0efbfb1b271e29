#pragma once
// Systems for non-negative least squares: those that a solve meets, and hard ones.

#include <string>
#include <vector>

#include <Eigen/Core>

#include "tests/benchmarks/random_light_sets.h"

namespace chiaro::benchmarks {

struct NnlsCase {
  std::string name;
  Eigen::MatrixXd a, b;   // rows × columns, rows × right-hand sides
  Eigen::MatrixXd start;  // columns × right-hand sides, ≥ 0: what the round before found
};

// The two rounds of a solve: weighted columns of grid lights, and of some 3000 lights around those that shine; with
// fewer rows, with wild weights and scales, with three right-hand sides.
std::vector<NnlsCase> transport_cases(const Stage& stage, SetNumber number, const TargetOptions& options);

std::vector<NnlsCase> synthetic_cases(unsigned seed);

}  // namespace chiaro::benchmarks
