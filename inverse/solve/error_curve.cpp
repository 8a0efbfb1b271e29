#include "inverse/solve/error_curve.h"

#include <algorithm>

namespace chiaro::inverse {

LightSet set_of(const LightEstimates& lights, double relative_l2) {
  LightSet set{{}, relative_l2};
  for (const LightEstimate& light : lights) set.lights.push_back(point_light(light));
  return set;
}

void put_in_curve(LightSet set, std::vector<LightSet>& curve) {
  if (set.lights.empty()) return;
  const auto at = std::find_if(curve.begin(), curve.end(), [&](const LightSet& other) {
    return other.lights.size() >= set.lights.size();  // as many, or more
  });
  if (at != curve.end() && at->lights.size() == set.lights.size()) {
    *at = std::move(set);
  } else {
    curve.insert(at, std::move(set));
  }
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
    const std::size_t next = curve[k - 1].lights.size() + 1;
    if (curve[k].lights.size() <= next) continue;
    const LightEstimates more = as_many_as_asked_for(light_estimates(curve[k - 1].lights), next);
    if (more.empty()) return;
    curve.insert(curve.begin() + std::ptrdiff_t(k), set_of(more, curve[k - 1].relative_l2));
  }
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const LightSet& best = k == 0 || curve[k].relative_l2 <= curve[k - 1].relative_l2 ? curve[k] : curve[k - 1];
    const LightEstimates lit = as_many_as_asked_for(light_estimates(best.lights), curve[k].lights.size());
    if (!lit.empty()) curve[k] = set_of(lit, best.relative_l2);
  }
}

}  // namespace chiaro::inverse
