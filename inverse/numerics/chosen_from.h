#pragma once

#include <cstddef>
#include <vector>

namespace chiaro::inverse::numerics {

// Those of these numbers alone, in their order.
template <class Value>
std::vector<Value> chosen_from(const std::vector<Value>& all, const std::vector<std::size_t>& chosen) {
  std::vector<Value> some;
  some.reserve(chosen.size());
  for (const std::size_t i : chosen) some.push_back(all[i]);
  return some;
}

}  // namespace chiaro::inverse::numerics
