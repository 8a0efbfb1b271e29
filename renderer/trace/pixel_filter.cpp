#include "renderer/trace/pixel_filter.h"

namespace chiaro::renderer {
namespace {

constexpr int kQuantiles = 2048;
constexpr float kRadius = 1.5F;

double blackman_harris_window(double x) {  // x in 0 … 1 across the window
  const double a = 2 * double(kPi) * x;
  return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
}

}  // namespace

PixelFilter PixelFilter::box() {
  PixelFilter filter;
  filter.quantiles_ = {-0.5F, 0.5F};
  return filter;
}

PixelFilter PixelFilter::blackman_harris() {
  constexpr int kSteps = 1 << 16;
  double total = 0;
  for (int i = 0; i < kSteps; ++i) total += blackman_harris_window((i + 0.5) / kSteps);
  PixelFilter filter;
  double sum = 0;
  int step = 0;
  for (int q = 0; q <= kQuantiles; ++q) {
    while (step < kSteps && sum < total * q / kQuantiles) sum += blackman_harris_window((step++ + 0.5) / kSteps);
    filter.quantiles_.push_back(kRadius * (2 * float(step) / kSteps - 1));
  }
  return filter;
}

float PixelFilter::offset(float u) const {
  const float at = u * float(quantiles_.size() - 1);
  const auto i = std::min(std::size_t(at), quantiles_.size() - 2);
  const float t = at - float(i);
  return (1 - t) * quantiles_[i] + t * quantiles_[i + 1];
}

}  // namespace chiaro::renderer
