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

FreshTrace trace_afresh(const SolveProblem& problem, const renderer::Lights& lights, int samples,
                        const SolveOptions& options, const renderer::Control& control) {
  renderer::Lights all = lights;
  all.insert(all.end(), problem.kept_lights.begin(), problem.kept_lights.end());
  const Receivers& receivers = problem.target.receivers;
  const renderer::TraceOptions trace{samples, problem.bake.bounces, fresh_seed(options.seed, 2), true};
  auto traced = trace_illumination_by_light(problem.tracer, receivers.samples, all, trace, control);
  traced.of_light.resize(lights.size());
  return {std::move(traced.total), std::move(traced.of_light)};
}

void judge(const SolveProblem& problem, const SolveOptions& options, FreshTrace traced, SolveResult& result) {
  const Target& target = problem.target;
  result.verification_noise = relative_standard_error(traced.all);
  result.illumination = std::move(traced.all.value);
  result.relative_l2 = relative_l2(result.illumination, target.illumination, target.weight);
  const double noise = std::hypot(result.verification_noise, result.target_noise);
  result.not_reached = places_not_reached(target, result.illumination, noise);
  result.advice = advice_for(problem, options, result);
}

}  // namespace chiaro::inverse
