#pragma once

#include <algorithm>
#include <cmath>

namespace chiaro::test {

// Mean and its standard error, as if samples were independent.
struct Mean {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double v) { sum += v, squares += v * v, ++count; }
  double value() const { return sum / count; }
  double error() const { return std::sqrt(std::max(0.0, squares / count - value() * value()) / count); }
};

}  // namespace chiaro::test
