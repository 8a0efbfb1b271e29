#include "renderer/trace/pixel_filter.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

constexpr int kSteps = 100000;

// Moments of the offsets along one axis.
struct Moments {
  double mean = 0, variance = 0, least = 1e9, most = -1e9;
};

Moments moments(const PixelFilter& filter) {
  Moments m;
  for (int i = 0; i < kSteps; ++i) {
    const Vec2f at = filter.sample({(float(i) + 0.5F) / kSteps, 0.5F});
    m.mean += double(at.x) / kSteps;
    m.variance += double(at.x) * double(at.x) / kSteps;
    m.least = std::min(m.least, double(at.x)), m.most = std::max(m.most, double(at.x));
  }
  m.variance -= m.mean * m.mean;
  return m;
}

TEST(PixelFilter, BoxIsUniformOverThePixel) {
  const Moments m = moments(PixelFilter::box());
  EXPECT_NEAR(m.mean, 0, 1e-6);
  EXPECT_NEAR(m.variance, 1.0 / 12, 1e-5);
  EXPECT_NEAR(m.least, -0.5, 1e-4);
  EXPECT_NEAR(m.most, 0.5, 1e-4);
}

TEST(PixelFilter, BlackmanHarrisHasTheWindowsVariance) {
  // In s = offset / 3 the window is Σ a_k cos(2πks) on ±½, and ∫ s² cos(2πks) ds = (-1)^k / (2π²k²), 1/12 for k = 0.
  const double a[4] = {0.35875, 0.48829, 0.14128, 0.01168};
  double second = a[0] / 12;
  for (int k = 1; k < 4; ++k) second += (k % 2 == 0 ? a[k] : -a[k]) / (2 * M_PI * M_PI * k * k);
  const Moments m = moments(PixelFilter::blackman_harris());
  EXPECT_NEAR(m.mean, 0, 1e-3);
  EXPECT_NEAR(m.variance, 9 * second / a[0], 0.01 * 9 * second / a[0]);
  EXPECT_GE(m.least, -1.5);
  EXPECT_LE(m.most, 1.5);
}

TEST(PixelFilter, BlackmanHarrisPutsTheRightShareIntoThePixel) {
  // ∫ over |s| ≤ 1/6 of the window, over all of it: a_0/3 + Σ a_k sin(πk/3) / (πk), over a_0.
  const double a[4] = {0.35875, 0.48829, 0.14128, 0.01168};
  double share = a[0] / 3;
  for (int k = 1; k < 4; ++k) share += a[k] * std::sin(M_PI * k / 3) / (M_PI * k);
  share /= a[0];
  const PixelFilter filter = PixelFilter::blackman_harris();
  int inside = 0;
  for (int i = 0; i < kSteps; ++i) {
    inside += std::abs(filter.sample({0.5F, (float(i) + 0.5F) / kSteps}).y) <= 0.5F ? 1 : 0;
  }
  EXPECT_NEAR(double(inside) / kSteps, share, 0.005);
}

TEST(PixelFilter, OffsetsGrowWithTheirNumber) {
  for (const PixelFilter& filter : {PixelFilter::box(), PixelFilter::blackman_harris()}) {
    float last = filter.sample({0, 0}).x;
    for (int i = 1; i <= 1000; ++i) {
      const float next = filter.sample({float(i) / 1000, 0}).x;
      EXPECT_GE(next, last);
      last = next;
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer
