#pragma once

#include "inverse/solve/observations.h"

namespace chiaro::inverse {

// Lights that may move, as they were traced and as they are now.
struct FreeLights {
  LightEstimates traced, now;
  std::vector<Column> brought;          // by each as traced
  std::vector<Column> indirect_traced;  // of it by bounces, at 1 cd
  std::vector<Column> indirect;         // the same where the light is now: that, until it is carried along
  std::vector<Column> carried;          // what that changed at all receivers; empty: nothing was
  std::vector<std::size_t> number;      // in the trace
};

// What is left without some of them, in ascending order.
FreeLights without(FreeLights free, const std::vector<std::size_t>& gone);

// Each dark light becomes the half of the brightest, where that stands.
void let_the_dark_share(FreeLights& free);

}  // namespace chiaro::inverse
