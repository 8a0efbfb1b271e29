#pragma once

#include <array>

#include "renderer/image/image.h"

namespace chiaro::renderer {

// Figures of frame `a` against the reference `b`, over R, G, B of all pixels.
struct ImageComparison {
  double relative_l2 = 0;  // ‖a − b‖ / ‖b‖
  double rmse = 0;
  double relative_mse = 0;  // mean of (a − b)² / (b² + 0.01²) over pixels and channels
  double psnr = 0;          // dB, peak = the largest value of b
  std::array<double, 3> mean_a{}, mean_b{};
  double max_difference = 0;
  int max_x = 0, max_y = 0;
  std::size_t not_finite = 0;  // pixels left out because either frame is not finite there
};

// Error where the sizes differ or R, G, B are missing (a single-channel image counts as grey).
ImageComparison compare_images(const Image& a, const Image& b);

// A, B, and |A − B| × 8 side by side, all three already display-referred except that the difference is taken in the
// values given.
Image comparison_picture(const Image& a, const Image& b);

}  // namespace chiaro::renderer
