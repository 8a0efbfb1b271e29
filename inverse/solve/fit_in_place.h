#pragma once

#include "inverse/solve/solve.h"

namespace chiaro::inverse {

// Intensities of lights that stay where they are, whatever theirs are now: by what each brings by a little path tracing
// to up to 50 000 receivers.
std::vector<Eigen::Array3d> refit_over_many(const SolveProblem& problem, const renderer::Lights& lights,
                                            const SolveOptions& options, const renderer::Control& control);

// The intensities of lights that stay where they are, of any kind that shines from somewhere, by least squares over
// what each brings by path tracing: no bake is needed. Error where none of them reaches the painted surfaces.
SolveResult fit_in_place(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control);

}  // namespace chiaro::inverse
