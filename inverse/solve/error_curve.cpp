#include "inverse/solve/error_curve.h"

#include <algorithm>

namespace chiaro::inverse {
namespace {

// Of the first set of as many, or of more.
std::vector<LightSet>::iterator place_of(const LightSet& set, std::vector<LightSet>& curve) {
  return std::find_if(curve.begin(), curve.end(),
                      [&](const LightSet& other) { return other.lights.size() >= set.lights.size(); });
}

}  // namespace

LightSet set_of(const LightEstimates& lights, double relative_l2) {
  LightSet set{{}, relative_l2};
  for (const LightEstimate& light : lights) set.lights.push_back(point_light(light));
  return set;
}

void put_in_curve(LightSet set, std::vector<LightSet>& curve) {
  const auto as_good = [&](const LightSet& other) {
    return other.lights.size() <= set.lights.size() && other.relative_l2 <= set.relative_l2;
  };
  if (set.lights.empty() || std::any_of(curve.begin(), curve.end(), as_good)) return;
  const auto at = place_of(set, curve);
  if (at != curve.end() && at->lights.size() == set.lights.size()) {
    *at = std::move(set);
  } else {
    curve.insert(at, std::move(set));
  }
}

void have_in_curve(LightSet set, std::vector<LightSet>& curve) {
  const auto at = place_of(set, curve);
  if (set.lights.empty() || (at != curve.end() && at->lights.size() == set.lights.size())) return;
  curve.insert(at, std::move(set));
}

LightEstimates as_many_as_asked_for(LightEstimates lights, std::size_t count) {
  std::erase_if(lights, is_dark);
  while (!lights.empty() && lights.size() < count) {
    const auto brightest = std::max_element(lights.begin(), lights.end(), [](const auto& a, const auto& b) {
      return a.intensity.sum() < b.intensity.sum();
    });
    brightest->intensity /= 2;
    lights.push_back(*brightest);
  }
  return lights;
}

void let_none_be_worse_than_fewer(std::vector<LightSet>& curve) {
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const LightSet& fewer = curve[k - 1];
    if (curve[k].relative_l2 <= fewer.relative_l2) continue;
    const std::size_t count = curve[k].lights.size();
    curve[k] = set_of(as_many_as_asked_for(light_estimates(fewer.lights), count), fewer.relative_l2);
  }
}

}  // namespace chiaro::inverse
