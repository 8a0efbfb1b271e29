#include "inverse/solve/known_corrections.h"

#include <algorithm>

namespace chiaro::inverse {

KnownCorrections::KnownCorrections(const ExactIndirect& exact, const LightResponse& response, double near)
    : exact_(exact), response_(response), near_(near) {}

bool KnownCorrections::has_all(const LightEstimates& lights) const {
  return std::all_of(lights.begin(), lights.end(), [&](const LightEstimate& light) { return is_corrected(light); });
}

// All at once, which takes little more than one.
void KnownCorrections::correct(std::vector<LightEstimates>& sets) {
  LightEstimates unknown;
  for (LightEstimates& set : sets) {
    for (LightEstimate& light : set) {
      if (!is_corrected(light) && !take_known(light)) unknown.push_back(light);
    }
  }
  exact_.correct(response_, unknown);
  auto next = unknown.begin();
  for (LightEstimates& set : sets) {
    for (LightEstimate& light : set) {
      if (!is_corrected(light)) light = *next++;
    }
  }
  known_.insert(known_.end(), unknown.begin(), unknown.end());
}

bool KnownCorrections::is_corrected(const LightEstimate& light) const {
  return light.correction.size() > 0 && (light.position - light.corrected_at).norm() <= near_;
}

// False: there is none.
bool KnownCorrections::take_known(LightEstimate& light) const {
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const LightEstimate& other) {
    return (light.position - other.corrected_at).norm() <= near_;
  });
  if (known == known_.end()) return false;
  light.correction = known->correction;
  light.corrected_at = known->corrected_at;
  return true;
}

}  // namespace chiaro::inverse
