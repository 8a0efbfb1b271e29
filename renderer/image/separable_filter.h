#pragma once
// Convolution of planes with filters that are products of one of x and one of y.

#include <vector>

namespace chiaro::renderer {

// One value a pixel, rows from the top.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;
};

// An odd number of weights; the middle one is the pixel's own, the first that of the pixel on the left or above.
using FilterWeights = std::vector<float>;

// Σ weights[k] × the value k − radius pixels on; beyond the border the border's value goes on.
Plane filter_rows(const Plane& plane, const FilterWeights& weights);
Plane filter_columns(const Plane& plane, const FilterWeights& weights);

}  // namespace chiaro::renderer
