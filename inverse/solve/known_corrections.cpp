#include "inverse/solve/known_corrections.h"

#include <algorithm>

namespace chiaro::inverse {

KnownCorrections::KnownCorrections(const ExactIndirect& exact, const LightResponse& response, double near)
    : exact_(exact), response_(response), near_(near), known_(near) {}

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
  for (LightEstimate& light : unknown) known_.add(light.corrected_at, std::move(light.correction));
}

bool KnownCorrections::is_corrected(const LightEstimate& light) const {
  return light.correction.size() > 0 && (light.position - light.corrected_at).norm() <= near_;
}

// False: there is none.
bool KnownCorrections::take_known(LightEstimate& light) const {
  const auto* const known = known_.find(light.position);
  if (known == nullptr) return false;
  light.correction = known->value;
  light.corrected_at = known->position;
  return true;
}

}  // namespace chiaro::inverse
