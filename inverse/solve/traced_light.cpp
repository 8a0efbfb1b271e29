#include "inverse/solve/traced_light.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "inverse/numerics/chosen_from.h"
#include "inverse/solve/not_reached.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {
namespace {

constexpr double kVerificationPaths = 2e7;  // spent on the fresh evaluation, if not asked otherwise
constexpr int kLeastVerificationSamples = 16, kMostVerificationSamples = 1024;
// Noise is estimated from so many paths at least, as that of fewer is not known either, unless it takes more than so
// many.
constexpr double kLeastPaths = 1 << 13, kMostFirstPaths = 1e6;
constexpr int kFirstPart = 8;          // of the samples, at most
constexpr int kMoreOfSamples = 4;      // at least, as the noise of few is known only roughly
constexpr std::uint64_t kParts = 100;  // purpose of the first one's seed
// As the error is known without this noise, it may be …
constexpr double kNoiseBesideTarget = 1;   // … of the target's …
constexpr double kNoiseOfFew = 2;          // … or twice, where each light brings much of it, …
constexpr std::size_t kFew = 7;            // … so many at most, …
constexpr double kLittleNoise = 0.03;      // … and that is no more than this …
constexpr double kNoiseBesideError = 0.3;  // … or of what the lights leave unexplained

bool has_fixed_light(const SolveProblem& problem) {
  return !problem.kept_lights.empty() || has_emission(problem.tracer.scene());
}

// One part of a trace.
FreshTrace trace_part(const SolveProblem& problem, const std::vector<renderer::SurfaceSample>& receivers,
                      const renderer::Lights& lights, int samples, std::size_t number, const SolveOptions& options,
                      const renderer::Control& control) {
  renderer::Lights all = lights;
  all.insert(all.end(), problem.kept_lights.begin(), problem.kept_lights.end());
  const renderer::TraceOptions trace{samples, problem.bake.bounces, fresh_seed(options.seed, kParts + number), true};
  const auto start = std::chrono::steady_clock::now();
  auto traced = trace_illumination_by_light(problem.tracer, receivers, all, trace, control);
  traced.of_light.resize(lights.size());
  return {std::move(traced.total), std::move(traced.of_light), samples, {samples}, renderer::seconds_since(start)};
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
  first.parts.insert(first.parts.end(), second.parts.begin(), second.parts.end());
  first.seconds += second.seconds;
  return first;
}

// Of receivers, each by its weight, what squared_error_of() tells.
struct SquaredSums {
  double error = 0, noise = 0, spread = 0, wanted = 0;

  // at: receiver's number in the illumination; i: in the target
  void add(const renderer::Illumination& illumination, std::size_t at, const Target& target, std::size_t i,
           double weight) {
    error += weight * squared_norm(illumination.value[at] - target.illumination[i]);
    wanted += weight * squared_norm(target.illumination[i]);
    if (illumination.standard_error.empty()) return;
    const double squared = weight * squared_norm(illumination.standard_error[at]);
    noise += squared;
    spread += squared * squared;
  }
  SquaredError relative() const {
    const double all = error > 0 ? error / wanted : 0;
    if (!(noise > 0)) return {all};
    return {all, noise / wanted, std::sqrt(2 * spread) / wanted};
  }
};

// How many receivers count, as the square of the sum of their weights is of the sum of their squares.
double receivers_that_count(const Target& target) {
  double sum = 0, squares = 0;
  for (const float weight : target.weight) sum += double(weight), squares += double(weight) * double(weight);
  return squares > 0 ? sum * sum / squares : double(target.receivers.size());
}

int samples_to_begin_with(const Target& target) {
  const double wanted = kLeastPaths / receivers_that_count(target);
  const double most = kMostFirstPaths / double(target.receivers.size());
  return int(std::clamp(std::min(wanted, most), double(kLeastVerificationSamples), double(kMostVerificationSamples)));
}

// Relative to the target.
double noise_that_does_not_matter(const FreshTrace& traced, const Target& target) {
  const double of_target = target_noise(target);
  const double unexplained = std::max(0.0, squared_error_of(traced, target).beyond_noise() - of_target * of_target);
  const double of_few = traced.of_light.size() <= kFew ? std::min(kNoiseOfFew * of_target, kLittleNoise) : 0;
  return std::max({kNoiseBesideTarget * of_target, of_few, kNoiseBesideError * std::sqrt(unexplained)});
}

// What a trace is of, and by what means.
struct Tracing {
  const SolveProblem& problem;
  const renderer::Lights& lights;
  const SolveOptions& options;
  const renderer::Control& control;

  FreshTrace part(int samples, std::size_t number) const {
    return trace_part(problem, problem.target.receivers.samples, lights, samples, number, options, control);
  }
  FreshTrace with_more(FreshTrace traced, int samples) const {
    if (samples <= 0) return traced;
    const FreshTrace more = part(samples, traced.parts.size());
    return joined(std::move(traced), more);
  }
  FreshTrace with_enough(FreshTrace traced, int most, const StageClock& clock) const {
    while (true) {
      const double noise = noise_of(traced, problem.target).value_or(0);
      const double may_be = noise_that_does_not_matter(traced, problem.target);
      int more = renderer::samples_for_noise(traced.samples, noise, may_be, most) - traced.samples;
      if (more <= 0) return traced;
      more = std::min(std::max(more, traced.samples / kMoreOfSamples), most - traced.samples);
      // At the speed of those before.
      const double in_time = std::floor(traced.samples * clock.seconds_left() / std::max(traced.seconds, 1e-6));
      const bool cut_short = more > in_time;
      traced.cut_short = cut_short;
      traced = with_more(std::move(traced), cut_short ? int(in_time) : more);
      if (cut_short) return traced;
    }
  }
};

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
  const int least = clock.is_limited() ? kLeastVerificationSamples : samples_to_begin_with(problem.target);
  const int few = std::min(all, least);
  const Tracing tracing{problem, lights, options, control};
  FreshTrace first = tracing.part(few, 0);
  // How long more would take is known now.
  if (clock.is_limited() && options.verification_samples == 0) return first;
  return tracing.with_enough(std::move(first), std::max(few, all / kFirstPart), StageClock(0));
}

FreshTrace trace_by_the_same_paths(const SolveProblem& problem, const renderer::Lights& lights, const FreshTrace& other,
                                   const SolveOptions& options, const renderer::Control& control) {
  const Tracing tracing{problem, lights, options, control};
  FreshTrace traced = tracing.part(other.parts.front(), 0);
  for (std::size_t k = 1; k < other.parts.size(); ++k) traced = tracing.with_more(std::move(traced), other.parts[k]);
  return traced;
}

FreshTrace completed(const SolveProblem& problem, const renderer::Lights& lights, FreshTrace first,
                     const SolveOptions& options, const renderer::Control& control, const StageClock& clock) {
  const int most = verification_samples(options, problem.target.receivers.size());
  const Tracing tracing{problem, lights, options, control};
  if (options.verification_samples == 0) return tracing.with_enough(std::move(first), most, clock);
  const int more = most - first.samples;
  return tracing.with_more(std::move(first), more);
}

FreshTrace trace_for_verification(const SolveProblem& problem, const renderer::Lights& lights,
                                  const SolveOptions& options, const renderer::Control& control,
                                  const StageClock& clock) {
  FreshTrace first = trace_first_part(problem, lights, options, control, clock);
  return completed(problem, lights, std::move(first), options, control, clock);
}

SquaredError squared_error_of(const FreshTrace& traced, const Target& target) {
  SquaredSums sums;
  for (std::size_t i = 0; i < target.receivers.size(); ++i)
    sums.add(traced.all, i, target, i, double(target.weight[i]));
  return sums.relative();
}

SquaredError squared_error_of(const FreshTrace& traced, const Target& target, const ReceiverDraw& draw) {
  SquaredSums sums;
  for (std::size_t k = 0; k < draw.chosen.size(); ++k) {
    const std::size_t i = draw.chosen[k];
    sums.add(traced.all, k, target, i, double(target.weight[i]) / draw.probability[k]);
  }
  return sums.relative();
}

FreshTrace part_of(const FreshTrace& traced, const ReceiverDraw& draw) {
  FreshTrace drawn;
  drawn.samples = traced.samples;
  drawn.parts = traced.parts;
  drawn.all.value = numerics::chosen_from(traced.all.value, draw.chosen);
  if (!traced.all.standard_error.empty()) {
    drawn.all.standard_error = numerics::chosen_from(traced.all.standard_error, draw.chosen);
  }
  for (const auto& light : traced.of_light) drawn.of_light.push_back(numerics::chosen_from(light, draw.chosen));
  return drawn;
}

FreshTrace trace_drawn(const SolveProblem& problem, const renderer::Lights& lights, const ReceiverDraw& draw,
                       int samples, const SolveOptions& options, const renderer::Control& control) {
  const auto receivers = numerics::chosen_from(problem.target.receivers.samples, draw.chosen);
  return trace_part(problem, receivers, lights, samples, 0, options, control);
}

double error_without_noise(const FreshTrace& traced, const Target& target) {
  const SquaredError error = squared_error_of(traced, target);
  return std::sqrt(std::min(error.all, std::max(error.beyond_noise(), error.noise_known_to)));
}

void judge(const SolveProblem& problem, const SolveOptions& options, FreshTrace traced, SolveResult& result) {
  const Target& target = problem.target;
  result.verification_noise = noise_of(traced, target);
  result.relative_l2 = error_without_noise(traced, target);
  result.illumination = std::move(traced.all.value);
  if (!result.verification_noise) return;  // by one path nobody can tell what is noise
  const double noise = std::hypot(*result.verification_noise, result.target_noise);
  result.not_reached = places_not_reached(target, result.illumination, noise);
  result.advice = advice_for(problem, options, result);
}

}  // namespace chiaro::inverse
