#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace chiaro::inverse::numerics {

// Numbers of the greatest of these values, the greatest first and of equal ones the first: so many at most.
inline std::vector<std::size_t> indices_of_greatest(const std::vector<double>& values, std::size_t most) {
  std::vector<std::size_t> indices(values.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  const auto count = std::ptrdiff_t(std::min(most, values.size()));
  std::partial_sort(indices.begin(), indices.begin() + count, indices.end(), [&](std::size_t a, std::size_t b) {
    return values[a] > values[b] || (values[a] == values[b] && a < b);
  });
  indices.resize(std::size_t(count));
  return indices;
}

}  // namespace chiaro::inverse::numerics
