#include "renderer/image/separable_filter.h"

#include <algorithm>

#include "renderer/core/control.h"

namespace chiaro::renderer {
namespace {

constexpr int kRowsPerTask = 16;

template <class FilterRow>
Plane filter_each_row(const Plane& plane, const FilterRow& filter_row) {
  Plane filtered{plane.width, plane.height, std::vector<float>(plane.values.size(), 0.0F)};
  parallel_for(std::size_t((plane.height + kRowsPerTask - 1) / kRowsPerTask), [&](std::size_t task) {
    const int first = int(task) * kRowsPerTask, end = std::min(first + kRowsPerTask, plane.height);
    for (int y = first; y < end; ++y) filter_row(y, &filtered.values[std::size_t(y) * std::size_t(plane.width)]);
  });
  return filtered;
}

const float* row_of(const Plane& plane, int y) {
  return &plane.values[std::size_t(std::clamp(y, 0, plane.height - 1)) * std::size_t(plane.width)];
}

void add_scaled(const float* source, float weight, int count, float* sum) {
  for (int x = 0; x < count; ++x) sum[x] += weight * source[x];
}

std::vector<float> padded_row(const float* row, int width, int radius) {
  std::vector<float> padded(std::size_t(width + 2 * radius));
  for (int x = -radius; x < width + radius; ++x) padded[std::size_t(x + radius)] = row[std::clamp(x, 0, width - 1)];
  return padded;
}

}  // namespace

Plane filter_rows(const Plane& plane, const FilterWeights& weights) {
  return filter_each_row(plane, [&](int y, float* sum) {
    const std::vector<float> padded = padded_row(row_of(plane, y), plane.width, int(weights.size() / 2));
    for (std::size_t k = 0; k < weights.size(); ++k) add_scaled(&padded[k], weights[k], plane.width, sum);
  });
}

Plane filter_columns(const Plane& plane, const FilterWeights& weights) {
  const int radius = int(weights.size() / 2);
  return filter_each_row(plane, [&](int y, float* sum) {
    for (int k = -radius; k <= radius; ++k) {
      add_scaled(row_of(plane, y + k), weights[std::size_t(k + radius)], plane.width, sum);
    }
  });
}

}  // namespace chiaro::renderer
