#include "inverse/solve/traced_light.h"

#include <algorithm>
#include <cmath>

#include "inverse/solve/not_reached.h"

namespace chiaro::inverse {
namespace {

constexpr double kVerificationPaths = 2e7;  // spent on the fresh evaluation, if not asked otherwise
constexpr int kLeastVerificationSamples = 16, kMostVerificationSamples = 1024;

bool has_fixed_light(const SolveProblem& problem) {
  const auto& materials = problem.tracer.scene().materials;
  return !problem.kept_lights.empty() ||
         std::any_of(materials.begin(), materials.end(),
                     [](const renderer::Material& m) { return max_component(m.emission) > 0; });
}

}  // namespace

std::uint64_t fresh_seed(std::uint64_t seed, std::uint64_t purpose) { return seed * 1000003 + 0x5eedf00dULL + purpose; }

std::vector<Vec3f> fixed_illumination(const SolveProblem& problem, const std::vector<renderer::SurfaceSample>& at,
                                      int samples, const SolveOptions& options, const renderer::Control& control) {
  if (!has_fixed_light(problem)) return std::vector<Vec3f>(at.size());
  const renderer::TraceOptions trace{samples, problem.bake.bounces, fresh_seed(options.seed, 1), true};
  return trace_illumination(problem.tracer, at, problem.kept_lights, trace, control).value;
}

int verification_samples(const SolveOptions& options, std::size_t receivers) {
  if (options.verification_samples > 0) return options.verification_samples;
  return std::clamp(int(kVerificationPaths / double(receivers)), kLeastVerificationSamples, kMostVerificationSamples);
}

void verify(const SolveProblem& problem, const SolveOptions& options, const renderer::Control& control,
            SolveResult& result) {
  renderer::Lights lights = problem.kept_lights;
  for (const FoundLight& found : result.lights) lights.emplace_back(found.light);
  const Target& target = problem.target;
  const renderer::TraceOptions trace{verification_samples(options, target.receivers.size()), problem.bake.bounces,
                                     fresh_seed(options.seed, 2), true};
  const auto traced = trace_illumination(problem.tracer, target.receivers.samples, lights, trace, control);
  result.illumination = traced.value;
  result.verification_noise = relative_standard_error(traced);
  result.relative_l2 = relative_l2(traced.value, target.illumination, target.weight);
  const double noise = std::hypot(result.verification_noise, result.target_noise);
  result.not_reached = places_not_reached(target, traced.value, noise);
  result.advice = advice_for(problem, options, result);
}

}  // namespace chiaro::inverse
