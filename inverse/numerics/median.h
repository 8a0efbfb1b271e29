#pragma once

#include <algorithm>
#include <vector>

namespace chiaro::inverse::numerics {

// The upper one of two middles; 0 of no values.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace chiaro::inverse::numerics
