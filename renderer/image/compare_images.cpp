#include "renderer/image/compare_images.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/image/difference_sums.h"

namespace chiaro::renderer {
namespace {

constexpr float kDifferenceGain = 8;

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
      result.mean_a[c] += a[c];
      result.mean_b[c] += b[c];
    }
  }

  ImageComparison finish() {
    if (differences.weight == 0) throw Error({"", "", "no pixel is finite in both pictures", "pictures without NaN"});
    for (int c = 0; c < 3; ++c) {
      result.mean_a[c] /= differences.weight / 3;
      result.mean_b[c] /= differences.weight / 3;
    }
    result.relative_l2 = differences.relative_l2();
    result.rmse = differences.rmse();
    result.relative_mse = differences.relative_mse();
    result.psnr = differences.psnr();
    result.max_difference = differences.max_difference;
    return result;
  }
};

// A difference that is no number shows as white rather than as nothing.
float shown_difference(float a, float b) {
  const float difference = kDifferenceGain * std::abs(a - b);
  return difference < 1 ? difference : 1;
}

}  // namespace

ImageComparison compare_images(const Image& a, const Image& b) {
  check_sizes(a, b);
  const ColorChannels channels_a = color_channels(a), channels_b = color_channels(b);
  PixelSums sums;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) sums.add(color_at(a, channels_a, x, y), color_at(b, channels_b, x, y), x, y);
  }
  return sums.finish();
}

Image comparison_picture(const Image& a, const Image& b) {
  check_sizes(a, b);
  const ColorChannels channels_a = color_channels(a), channels_b = color_channels(b);
  Image picture = make_image(3 * a.width, a.height, {"R", "G", "B"});
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const Color color_a = color_at(a, channels_a, x, y), color_b = color_at(b, channels_b, x, y);
      for (int c = 0; c < 3; ++c) {
        picture.at(x, y)[c] = color_a[c];
        picture.at(a.width + x, y)[c] = color_b[c];
        picture.at(2 * a.width + x, y)[c] = shown_difference(color_a[c], color_b[c]);
      }
    }
  }
  return picture;
}

}  // namespace chiaro::renderer
