#pragma once
// What a solve traces by itself, beside the transport of a bake.

#include "inverse/solve/solve.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

// Seeds of a solve's own path tracing differ from those that a target was traced with, whatever seed the user gave
// both.
std::uint64_t fresh_seed(std::uint64_t seed, std::uint64_t purpose);

// What shines without the lights sought: emissive surfaces and kept lights.
std::vector<Vec3f> fixed_illumination(const SolveProblem& problem, const std::vector<renderer::SurfaceSample>& at,
                                      int samples, const SolveOptions& options, const renderer::Control& control);

// Paths per receiver of a final evaluation, as asked for or by the number of receivers.
int verification_samples(const SolveOptions& options, std::size_t receivers);

// Traces the lights of the result afresh over all receivers, and fills in how far they are from the target.
void verify(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
            SolveResult& result);

}  // namespace chiaro::inverse
