#include "inverse/solve/fill_up_lights.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "inverse/solve/insertion.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;

constexpr double kShare = 1e-5;       // of the brightest light, for a light that would be dark
constexpr std::size_t kStarts = 12;   // of all arrangements from scratch
constexpr std::size_t kFarthest = 8;  // places that are tried beside lights that make room

class FillingUp {
 public:
  FillingUp(const LightResponse& response, const Observations& observations, const FillUpLimits& limits)
      : response_(response),
        observations_(observations),
        limits_(limits),
        candidates_(response.places_near_grid_lights()) {}

  LightEstimates fill_up(LightEstimates lights, std::size_t wanted) const {
    while (lights.size() < wanted && (add_beside(lights) || add_where_others_make_room(lights))) continue;
    if (lights.size() < wanted) lights = arranged_anew(wanted).value_or(lights);
    if (lights.empty()) return lights;
    refit_intensities(observations_, evaluate_columns(response_, lights, Evaluation::kTracedVisibility), lights);
    light_the_dark(lights);
    return lights;
  }

 private:
  bool fits_in(const std::vector<Vector3d>& positions, const Vector3d& further) const {
    return response_.places().has_room(further, positions);
  }

  // At the candidate that explains most of what is left, all others staying where they are; where none explains any, at
  // the one whose light brings least.
  bool add_beside(LightEstimates& lights) const {
    const std::vector<Vector3d> positions = positions_of(lights);
    LightEstimates fitting;
    for (const Vector3d& candidate : candidates_) {
      if (fits_in(positions, candidate)) fitting.push_back({candidate, Eigen::Array3d::Zero()});
    }
    if (fitting.empty()) return false;
    if (limits_.clock.out_of_time()) fitting.resize(1);
    const Observations left = less(observations_, response_, lights);
    std::vector<double> gain(fitting.size()), brought(fitting.size());
    renderer::parallel_for(fitting.size(), "filling up", limits_.control.without_progress(), [&](std::size_t k) {
      const Column column = evaluate_column(response_, fitting[k], Evaluation::kTracedVisibility);
      gain[k] = fit_intensity(left, column, fitting[k]);
      brought[k] = contribution_norm(left, column, Eigen::Array3d::Ones());
    });
    const auto most = std::max_element(gain.begin(), gain.end()),
               least = std::min_element(brought.begin(), brought.end());
    lights.push_back(fitting[std::size_t(*most > 0 ? most - gain.begin() : least - brought.begin())]);
    return true;
  }

  static double distance_to_any(const std::vector<Vector3d>& positions, const Vector3d& candidate) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : positions) least = std::min(least, (p - candidate).norm());
    return least;
  }

  bool add_where_others_make_room(LightEstimates& lights) const {
    const std::vector<Vector3d> positions = positions_of(lights);
    std::vector<Vector3d> farthest = candidates_;
    std::stable_sort(farthest.begin(), farthest.end(), [&](const Vector3d& a, const Vector3d& b) {
      return distance_to_any(positions, a) > distance_to_any(positions, b);
    });
    farthest.resize(std::min(kFarthest, farthest.size()));
    for (const Vector3d& candidate : farthest) {
      limits_.control.stop_if_requested();
      std::vector<Vector3d> all = positions;
      all.push_back(candidate);
      if (!response_.places().settle(all)) continue;
      lights = lights_at(all);
      return true;
    }
    return false;
  }

  static LightEstimates lights_at(const std::vector<Vector3d>& positions) {
    LightEstimates lights;
    for (const Vector3d& p : positions) lights.push_back({p, Eigen::Array3d::Zero()});
    return lights;
  }

  // Each as near to the others as may be, from one candidate or another on.
  std::optional<LightEstimates> arranged_anew(std::size_t wanted) const {
    const std::size_t starts = std::min(kStarts, candidates_.size());
    for (std::size_t k = 0; k < starts; ++k) {
      std::vector<Vector3d> positions;
      std::optional<Vector3d> next = candidates_[k * candidates_.size() / starts];
      if (!fits_in({}, *next)) next = nearest_that_fits(positions, *next);
      while (next) {
        limits_.control.stop_if_requested();
        positions.push_back(*next);
        if (positions.size() == wanted) return lights_at(positions);
        next = nearest_that_fits(positions, positions.front());
      }
    }
    return std::nullopt;
  }

  std::optional<Vector3d> nearest_that_fits(const std::vector<Vector3d>& positions, const Vector3d& to) const {
    std::optional<Vector3d> nearest;
    for (const Vector3d& candidate : candidates_) {
      const bool nearer = !nearest || (candidate - to).norm() < (*nearest - to).norm();
      if (nearer && fits_in(positions, candidate)) nearest = candidate;
    }
    return nearest;
  }

  const LightResponse& response_;
  const Observations& observations_;
  const FillUpLimits& limits_;
  std::vector<Vector3d> candidates_;
};

}  // namespace

void light_the_dark(LightEstimates& lights) {
  for (LightEstimate& light : lights) {
    if (!is_dark(light)) continue;
    const auto brightest = brightest_light(lights);
    light.intensity = kShare * brightest->intensity;
    brightest->intensity *= 1 - kShare;
  }
}

LightEstimates filled_up(const LightResponse& response, const Observations& observations, LightEstimates lights,
                         std::size_t wanted, const FillUpLimits& limits) {
  std::erase_if(lights, is_dark);
  if (lights.size() >= wanted) return lights;
  return FillingUp(response, observations, limits).fill_up(std::move(lights), wanted);
}

}  // namespace chiaro::inverse
