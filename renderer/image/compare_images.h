#pragma once

#include <array>
#include <optional>

#include "renderer/image/image.h"

namespace chiaro::renderer {

// Figures of one channel.
struct ChannelComparison {
  double relative_l2 = 0, rmse = 0, relative_mse = 0, psnr = 0, mean_a = 0, mean_b = 0, max_difference = 0;
};

// Figures of frame `a` against the reference `b`, over R, G, B of all pixels.
struct ImageComparison {
  double relative_l2 = 0;  // ‖a − b‖ / ‖b‖
  double rmse = 0;
  double relative_mse = 0;  // mean of (a − b)² / (b² + 0.01²) over pixels and channels
  double psnr = 0;          // dB
  std::array<double, 3> mean_a{}, mean_b{};
  double max_difference = 0;
  int max_x = 0, max_y = 0;
  std::size_t not_finite = 0;                   // pixels left out because either frame is not finite there
  std::array<ChannelComparison, 3> channels{};  // R, G, B
};

// Pixels from (x0, y0) to before (x1, y1), rows from the top.
struct PixelRegion {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct CompareOptions {
  std::optional<PixelRegion> region;  // absent: all pixels
  std::optional<double> peak;         // of psnr; absent: the largest value of b (of the channel, for a channel's)
};

// Error where the sizes differ, R, G, B are missing (a single-channel image counts as grey), or the region is not in
// the image.
ImageComparison compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

// The mean of a one-channel image over the pixels of `region` (absent: all) where it is finite.
double mean_value(const Image& values, const std::optional<PixelRegion>& region = {});

}  // namespace chiaro::renderer
