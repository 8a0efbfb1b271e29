#include "inverse/solve/traced_light.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "inverse/solve/not_reached.h"
#include "inverse/solve/observe_target.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {
namespace {

constexpr double kVerificationPaths = 2e7;  // spent on the fresh evaluation, if not asked otherwise
constexpr int kLeastVerificationSamples = 16, kMostVerificationSamples = 1024;
constexpr int kFirstPart = 8;               // of the samples
constexpr double kNoiseBesideTarget = 0.5;  // of the target's: adds an eighth to it
constexpr double kNoiseBesideError = 0.1;   // of what the lights leave unexplained

bool has_fixed_light(const SolveProblem& problem) {
  const auto& materials = problem.tracer.scene().materials;
  return !problem.kept_lights.empty() ||
         std::any_of(materials.begin(), materials.end(),
                     [](const renderer::Material& m) { return max_component(m.emission) > 0; });
}

FreshTrace trace_afresh(const SolveProblem& problem, const renderer::Lights& lights, int samples, std::uint64_t seed,
                        const renderer::Control& control) {
  renderer::Lights all = lights;
  all.insert(all.end(), problem.kept_lights.begin(), problem.kept_lights.end());
  const renderer::TraceOptions trace{samples, problem.bake.bounces, seed, true};
  const auto start = std::chrono::steady_clock::now();
  auto traced = trace_illumination_by_light(problem.tracer, problem.target.receivers.samples, all, trace, control);
  traced.of_light.resize(lights.size());
  return {std::move(traced.total), std::move(traced.of_light), samples, renderer::seconds_since(start)};
}

// Both together, as of all their samples.
FreshTrace joined(FreshTrace first, const FreshTrace& second) {
  const float b = float(second.samples) / float(first.samples + second.samples);
  for (std::size_t l = 0; l < first.of_light.size(); ++l) {
    for (std::size_t i = 0; i < first.of_light[l].size(); ++i) {
      first.of_light[l][i] = (1 - b) * first.of_light[l][i] + b * second.of_light[l][i];
    }
  }
  first.all = joined(std::move(first.all), first.samples, second.all, second.samples);
  first.samples += second.samples;
  first.seconds += second.seconds;
  return first;
}

// Relative to the target.
double noise_that_does_not_matter(const SolveProblem& problem, const FreshTrace& traced) {
  const Target& target = problem.target;
  const double noise = noise_of(traced, target).value_or(0), of_target = target_noise(target);
  const double error = relative_l2(traced.all.value, target.illumination, target.weight);
  const double unexplained = std::sqrt(std::max(0.0, error * error - noise * noise - of_target * of_target));
  return std::max(kNoiseBesideTarget * of_target, kNoiseBesideError * unexplained);
}

// At the speed of the first part.
double samples_within(double seconds, const FreshTrace& first) {
  return std::floor(first.samples * seconds / std::max(first.seconds, 1e-6));
}

}  // namespace

std::uint64_t fresh_seed(std::uint64_t seed, std::uint64_t purpose) { return seed * 1000003 + 0x5eedf00dULL + purpose; }

std::vector<Vec3f> fixed_illumination(const SolveProblem& problem, const std::vector<renderer::SurfaceSample>& at,
                                      int samples, const SolveOptions& options, const renderer::Control& control) {
  if (!has_fixed_light(problem)) return std::vector<Vec3f>(at.size());
  const renderer::TraceOptions trace{samples, problem.bake.bounces, fresh_seed(options.seed, 1), true};
  return trace_illumination(problem.tracer, at, problem.kept_lights, trace, control).value;
}

std::optional<double> noise_of(const FreshTrace& traced, const Target& target) {
  return relative_standard_error(traced.all, target.weight);
}

int verification_samples(const SolveOptions& options, std::size_t receivers) {
  if (options.verification_samples > 0) return options.verification_samples;
  return std::clamp(int(kVerificationPaths / double(receivers)), kLeastVerificationSamples, kMostVerificationSamples);
}

FreshTrace trace_first_part(const SolveProblem& problem, const renderer::Lights& lights, const SolveOptions& options,
                            const renderer::Control& control, const StageClock& clock) {
  const int all = verification_samples(options, problem.target.receivers.size());
  // How long they take is known afterwards.
  const bool hurried = clock.is_limited() && options.verification_samples == 0;
  const int first =
      std::min(all, hurried ? kLeastVerificationSamples : std::max(kLeastVerificationSamples, all / kFirstPart));
  return trace_afresh(problem, lights, first, fresh_seed(options.seed, 2), control);
}

FreshTrace completed(const SolveProblem& problem, const renderer::Lights& lights, FreshTrace first,
                     const SolveOptions& options, const renderer::Control& control, const StageClock& clock) {
  const int most = verification_samples(options, problem.target.receivers.size());
  const int needed = options.verification_samples > 0
                         ? most
                         : renderer::samples_for_noise(first.samples, noise_of(first, problem.target).value_or(0),
                                                       noise_that_does_not_matter(problem, first), most);
  int more = needed - first.samples;
  if (options.verification_samples == 0 && more > samples_within(clock.seconds_left(), first)) {
    more = int(samples_within(clock.seconds_left(), first));
    first.cut_short = true;
  }
  if (more <= 0) return first;
  return joined(std::move(first), trace_afresh(problem, lights, more, fresh_seed(options.seed, 4), control));
}

FreshTrace trace_for_verification(const SolveProblem& problem, const renderer::Lights& lights,
                                  const SolveOptions& options, const renderer::Control& control,
                                  const StageClock& clock) {
  FreshTrace first = trace_first_part(problem, lights, options, control, clock);
  return completed(problem, lights, std::move(first), options, control, clock);
}

void judge(const SolveProblem& problem, const SolveOptions& options, FreshTrace traced, SolveResult& result) {
  const Target& target = problem.target;
  result.verification_noise = noise_of(traced, target);
  result.illumination = std::move(traced.all.value);
  result.relative_l2 = relative_l2(result.illumination, target.illumination, target.weight);
  if (!result.verification_noise) return;  // by one path nobody can tell what is noise
  const double noise = std::hypot(*result.verification_noise, result.target_noise);
  result.not_reached = places_not_reached(target, result.illumination, noise);
  result.advice = advice_for(problem, options, result);
}

}  // namespace chiaro::inverse
