#include "inverse/solve/enough_lights.h"

#include <algorithm>
#include <optional>

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

// The set with one light more: no worse, as one that does not help hardly shines, unless others have to make room for
// it. Nothing where there is no place.
std::optional<LightSet> with_one_more(const RegionSearch& searched, const FillUpLimits& limits, bool by_held_out,
                                      const LightSet& set) {
  LightEstimates lights = light_estimates(set.lights);
  const LightEstimates more = filled_up(searched.response, searched.judged, lights, lights.size() + 1, limits);
  if (more.size() != lights.size() + 1) return std::nullopt;
  const double error = searched.error_in_curve(more, by_held_out);
  if (error <= set.relative_l2) return set_of(more, error);
  if (!searched.response.places().has_room(more.back().position, positions_of(lights))) return set_of(more, error);
  lights.push_back({more.back().position, Eigen::Array3d::Zero()});
  light_the_dark(lights);
  return set_of(lights, set.relative_l2);
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

void complete_curve(const SolveProblem& problem, const RegionSearch& searched, const FillUpLimits& limits,
                    bool by_held_out, std::vector<LightSet>& curve) {
  if (may_share_places(problem)) return let_none_be_worse_than_fewer(curve);
  for (std::size_t k = 1; k < curve.size() && !limits.clock.out_of_time(); ++k) {
    const LightSet& fewer = curve[k - 1];
    const bool is_missing = curve[k].lights.size() > fewer.lights.size() + 1;
    if (!is_missing && curve[k].relative_l2 <= fewer.relative_l2) continue;
    std::optional<LightSet> set = with_one_more(searched, limits, by_held_out, fewer);
    if (set && (is_missing || set->relative_l2 < curve[k].relative_l2)) put_in_curve(*std::move(set), curve);
  }
}

}  // namespace chiaro::inverse
