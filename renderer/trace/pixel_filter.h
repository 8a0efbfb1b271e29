#pragma once

#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

// Pixel filters by filter importance sampling (Ernst, Stamminger, Greiner, 2006): every sample has weight one, and its
// place on the film is drawn from the filter.
class PixelFilter {
 public:
  static PixelFilter box();
  // Blackman–Harris, radius 1.5 pixels; the four-term window of Harris, 1978.
  static PixelFilter blackman_harris();

  // Offset from the pixel's centre, pixels.
  Vec2f sample(Vec2f u) const { return {offset(u.x), offset(u.y)}; }

 private:
  float offset(float u) const;
  std::vector<float> quantiles_;  // offsets at equal steps of the distribution function
};

}  // namespace chiaro::renderer
