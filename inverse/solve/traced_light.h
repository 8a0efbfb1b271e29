#pragma once
// What a solve traces by itself, beside the transport of a bake.

#include <algorithm>
#include <optional>

#include "inverse/solve/observe_target.h"
#include "inverse/solve/solve.h"
#include "inverse/solve/stage_clock.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

// Seeds of a solve's own path tracing differ from those that a target was traced with, whatever seed the user gave
// both.
std::uint64_t fresh_seed(std::uint64_t seed, std::uint64_t purpose);

inline constexpr int kFixedSamples = 512;  // enough of fixed_illumination()

// What shines without the lights sought: emissive surfaces and kept lights.
std::vector<Vec3f> fixed_illumination(const SolveProblem& problem, const std::vector<renderer::SurfaceSample>& at,
                                      int samples, const SolveOptions& options, const renderer::Control& control);

// Paths per receiver of a final evaluation: as asked for, or the most that this number of receivers gets.
int verification_samples(const SolveOptions& options, std::size_t receivers);

// Receivers' illumination, path traced afresh: of all, where nothing else is said.
struct FreshTrace {
  renderer::Illumination all;                // cd/m²; with what shines anyway
  std::vector<std::vector<Vec3f>> of_light;  // of the lights found, in their order
  int samples = 0;                           // paths per receiver …
  std::vector<int> parts;                    // … of each part that was traced by itself, with a seed of its own
  double seconds = 0;                        // that they took
  bool cut_short = false;                    // there was no time for as many as it would have taken
};

// Relative to its light, as (3.6) weighs it; absent: one path does not tell.
std::optional<double> noise_of(const FreshTrace& traced, const Target& target);

// Of a trace, relative to the target, as (3.6) weighs it.
struct SquaredError {
  double all = 0;
  double noise = 0;           // what its own noise is expected to bring …
  double noise_known_to = 0;  // … give or take so much
  double beyond_noise() const { return std::max(0.0, all - noise); }
};
SquaredError squared_error_of(const FreshTrace& traced, const Target& target);
// As far as receivers drawn from all tell, of which alone this trace is.
SquaredError squared_error_of(const FreshTrace& traced, const Target& target, const ReceiverDraw& draw);

// Of the lights, over all receivers (3.6): the squared noise of their trace, as far as it is known, is taken out, and
// no less is left than that is known to.
double error_without_noise(const FreshTrace& traced, const Target& target);

// With as many samples as were asked for; or else with as many as it takes until its noise is no more than that of the
// target (of few lights twice as much, up to 3 %), or little beside what the lights leave unexplained, and no more than
// verification_samples(), nor than clock has time for.
FreshTrace trace_for_verification(const SolveProblem& problem, const renderer::Lights& lights,
                                  const SolveOptions& options, const renderer::Control& control,
                                  const StageClock& clock);
// The same in two: no more than an eighth of the samples, or where time is limited as few as may be, by which one may
// decide against the lights, and then the others.
FreshTrace trace_first_part(const SolveProblem& problem, const renderer::Lights& lights, const SolveOptions& options,
                            const renderer::Control& control, const StageClock& clock);
// As another trace, part by part: of lights nearby it has nearly the same noise.
FreshTrace trace_by_the_same_paths(const SolveProblem& problem, const renderer::Lights& lights, const FreshTrace& other,
                                   const SolveOptions& options, const renderer::Control& control);
FreshTrace completed(const SolveProblem& problem, const renderer::Lights& lights, FreshTrace first,
                     const SolveOptions& options, const renderer::Control& control, const StageClock& clock);

// What a trace of all receivers has of those drawn.
FreshTrace part_of(const FreshTrace& traced, const ReceiverDraw& draw);
// Of receivers drawn alone, by so many paths of each.
FreshTrace trace_drawn(const SolveProblem& problem, const renderer::Lights& lights, const ReceiverDraw& draw,
                       int samples, const SolveOptions& options, const renderer::Control& control);

// Fills in how far the lights of the result are from the target.
void judge(const SolveProblem& problem, const SolveOptions& options, FreshTrace traced, SolveResult& result);

}  // namespace chiaro::inverse
