#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Intensities of lights at their places, fitted over up to 50 000 receivers.
inline constexpr std::size_t kManyReceivers = 50000;

struct PlacedFit {
  std::vector<Eigen::Array3d> intensity;
  double error = 0;        // by the objective, over these receivers
  double relative_l2 = 0;  // (3.6)
};
// Of each set, over so many receivers at most, by what each of its lights brings by a little path tracing, whatever its
// intensity is now: to compare sets by.
std::vector<PlacedFit> refit_over_many(const SolveProblem& problem, const std::vector<renderer::Lights>& sets,
                                       std::size_t receivers, const SolveOptions& options,
                                       const renderer::Control& control);

// The intensities of lights that stay where they are, of any kind that shines from somewhere, by least squares over
// what each brings by path tracing: no bake is needed. Error where none of them reaches the painted surfaces.
SolveResult fit_in_place(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control);

}  // namespace chiaro::inverse
