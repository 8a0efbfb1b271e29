#include "inverse/solve/enough_lights.h"

#include <algorithm>

#include "inverse/solve/error_curve.h"

namespace chiaro::inverse {
namespace {

// Of sets of fewer lights than these the one that is best, if it is better.
LightEstimates better_of_fewer(const RegionSearch& searched, const Optimum& optimum) {
  const LightSet* best = nullptr;
  double least = optimum.curve_by_held_out
                     ? searched.held_out_error(optimum.lights)
                     : relative_error(searched.reported, illumination_of(searched.response, optimum.lights));
  for (const LightSet& set : optimum.error_curve) {
    if (set.lights.size() >= optimum.lights.size() || !(set.relative_l2 < least)) continue;
    best = &set;
    least = set.relative_l2;
  }
  return best != nullptr ? light_estimates(best->lights) : LightEstimates();
}

}  // namespace

bool fill_up_to_wanted(const SolveProblem& problem, const SolveOptions& options, const RegionSearch& searched,
                       const FillUpLimits& limits, Optimum& optimum) {
  const std::size_t before = optimum.lights.size(), wanted = std::size_t(std::max(1, options.exact_lights));
  const auto filled = [&](LightEstimates lights) {
    return filled_up(searched.response, searched.judged, std::move(lights), wanted, limits);
  };
  if (may_share_places(problem)) optimum.lights = as_many_as_asked_for(std::move(optimum.lights), wanted);
  optimum.lights = filled(std::move(optimum.lights));
  const bool more = optimum.lights.size() > before;
  if (may_share_places(problem) || options.exact_lights == 0 || optimum.held > 0) return more;
  LightEstimates others = better_of_fewer(searched, optimum);
  if (others.empty()) return more;
  others = filled(std::move(others));
  const auto error = [&](const LightEstimates& lights) {
    return relative_error(searched.judged, illumination_of(searched.response, lights));
  };
  const bool better = others.size() >= wanted && error(others) < error(optimum.lights);
  if (better) optimum.lights = std::move(others);
  return more || better;
}

}  // namespace chiaro::inverse
