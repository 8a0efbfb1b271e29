#pragma once

#include "inverse/transport/receivers.h"

namespace chiaro::inverse {

// So many of the receivers, spread evenly over their order.
inline Receivers thinned(const Receivers& all, std::size_t count) {
  Receivers some;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (2 * k + 1) * all.size() / (2 * count);
    some.positions.push_back(all.positions[i]);
    some.normals.push_back(all.normals[i]);
    some.samples.push_back(all.samples[i]);
  }
  return some;
}

}  // namespace chiaro::inverse
