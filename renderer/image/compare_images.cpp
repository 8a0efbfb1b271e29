#include "renderer/image/compare_images.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/image/difference_sums.h"

namespace chiaro::renderer {
namespace {

using ColorChannels = std::array<int, 3>;

ColorChannels color_channels(const Image& image) {
  if (image.channel_count() == 1) return {0, 0, 0};
  const ColorChannels channels{image.find_channel("R"), image.find_channel("G"), image.find_channel("B")};
  if (*std::min_element(channels.begin(), channels.end()) >= 0) return channels;
  throw Error({"", "", fmt::format("a picture has the channels {}", fmt::join(image.channel_names, ", ")),
               "R, G and B, or a single channel"});
}

void check_sizes(const Image& a, const Image& b) {
  if (a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0) return;
  throw Error({"", "", fmt::format("the pictures are {} x {} and {} x {} pixels", a.width, a.height, b.width, b.height),
               "two pictures of the same size"});
}

using Color = std::array<float, 3>;

Color color_at(const Image& image, const ColorChannels& channels, int x, int y) {
  const float* pixel = image.at(x, y);
  return {pixel[channels[0]], pixel[channels[1]], pixel[channels[2]]};
}

bool all_finite(const Color& color) {
  return std::all_of(color.begin(), color.end(), [](float value) { return std::isfinite(value); });
}

struct PixelSums {
  DifferenceSums differences;
  std::array<DifferenceSums, 3> channels;
  ImageComparison result;  // means are sums until all pixels are in

  void add(const Color& a, const Color& b, int x, int y) {
    if (!all_finite(a) || !all_finite(b)) {
      ++result.not_finite;
      return;
    }
    for (int c = 0; c < 3; ++c) {
      if (differences.add(a[c], b[c])) {
        result.max_x = x;
        result.max_y = y;
      }
      channels[c].add(a[c], b[c]);
      result.mean_a[c] += a[c];
      result.mean_b[c] += b[c];
    }
  }

  ImageComparison finish(const std::optional<double>& peak) {
    for (int c = 0; c < 3; ++c) {
      result.mean_a[c] /= differences.weight / 3;
      result.mean_b[c] /= differences.weight / 3;
      fill(channels[c], peak, result.channels[c]);
      result.channels[c].mean_a = result.mean_a[c];
      result.channels[c].mean_b = result.mean_b[c];
    }
    fill(differences, peak, result);
    return result;
  }

  template <class Figures>
  static void fill(const DifferenceSums& sums, const std::optional<double>& peak, Figures& figures) {
    figures.relative_l2 = sums.relative_l2();
    figures.rmse = sums.rmse();
    figures.relative_mse = sums.relative_mse();
    figures.psnr = sums.psnr(peak.value_or(sums.peak));
    figures.max_difference = sums.max_difference;
    if (sums.weight > 0) return;
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    figures.relative_l2 = figures.psnr = figures.max_difference = kUnknown;
  }
};

PixelRegion region_of(const Image& image, const std::optional<PixelRegion>& region) {
  if (!region) return {0, 0, image.width, image.height};
  const PixelRegion& r = *region;
  if (0 <= r.x0 && r.x0 < r.x1 && r.x1 <= image.width && 0 <= r.y0 && r.y0 < r.y1 && r.y1 <= image.height) return r;
  throw Error({"", "", fmt::format("region {},{},{},{} is not in the picture", r.x0, r.y0, r.x1, r.y1),
               fmt::format("x0 < x1 up to {}, y0 < y1 up to {}", image.width, image.height)});
}

}  // namespace

ImageComparison compare_images(const Image& a, const Image& b, const CompareOptions& options) {
  check_sizes(a, b);
  const ColorChannels channels_a = color_channels(a), channels_b = color_channels(b);
  const PixelRegion region = region_of(a, options.region);
  PixelSums sums;
  for (int y = region.y0; y < region.y1; ++y) {
    for (int x = region.x0; x < region.x1; ++x) {
      sums.add(color_at(a, channels_a, x, y), color_at(b, channels_b, x, y), x, y);
    }
  }
  return sums.finish(options.peak);
}

double mean_value(const Image& values, const std::optional<PixelRegion>& region) {
  const PixelRegion r = region_of(values, region);
  double sum = 0, count = 0;
  for (int y = r.y0; y < r.y1; ++y) {
    for (int x = r.x0; x < r.x1; ++x) {
      if (!std::isfinite(*values.at(x, y))) continue;
      sum += *values.at(x, y);
      ++count;
    }
  }
  return sum / count;
}

}  // namespace chiaro::renderer
