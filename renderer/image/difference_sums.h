#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace chiaro::renderer {

// Sums over pairs of values (a, reference b), each with a weight, and the figures that follow from them. Of a reference
// of all zeros: relative_l2 is 0 where `a` is zero too, else infinite. psnr of equal values is infinite.
struct DifferenceSums {
  double weight = 0;
  double squared = 0;           // Σ w (a − b)²
  double relative_squared = 0;  // Σ w (a − b)² / (b² + 0.01²)
  double reference = 0;         // Σ w b²
  double peak = 0;              // the largest b
  double max_difference = 0;    // the largest |a − b|

  // Whether this pair is the first with the largest difference so far.
  bool add(double a, double b, double w = 1) {
    const double d = a - b;
    weight += w;
    squared += w * d * d;
    relative_squared += w * d * d / (b * b + 0.01 * 0.01);
    reference += w * b * b;
    peak = std::max(peak, b);
    if (std::abs(d) <= max_difference) return false;
    max_difference = std::abs(d);
    return true;
  }

  double relative_l2() const { return squared > 0 ? std::sqrt(squared / reference) : 0; }
  double rmse() const { return std::sqrt(squared / weight); }
  double relative_mse() const { return relative_squared / weight; }
  double psnr() const { return psnr(peak); }  // dB
  double psnr(double of_peak) const {
    return squared > 0 ? 20 * std::log10(of_peak / rmse()) : std::numeric_limits<double>::infinity();
  }
};

}  // namespace chiaro::renderer
