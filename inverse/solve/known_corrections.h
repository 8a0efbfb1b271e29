#pragma once

#include "inverse/solve/exact_indirect.h"
#include "inverse/solve/known_places.h"

namespace chiaro::inverse {

// Exact indirect light of the lights of one search, computed once wherever several of them come to stand.
class KnownCorrections {
 public:
  // near: metres to a place so near that indirect light hardly is another. Keeps references.
  KnownCorrections(const ExactIndirect& exact, const LightResponse& response, double near);

  // Each has the correction of where it stands, or near it.
  bool has_all(const LightEstimates& lights) const;
  // Gives them those that they lack.
  void correct(std::vector<LightEstimates>& sets);

 private:
  bool is_corrected(const LightEstimate& light) const;
  bool take_known(LightEstimate& light) const;

  const ExactIndirect& exact_;
  const LightResponse& response_;
  double near_;
  KnownPlaces<Column> known_;  // corrections
};

}  // namespace chiaro::inverse
