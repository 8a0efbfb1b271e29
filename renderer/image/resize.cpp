#include "renderer/image/resize.h"

#include <algorithm>
#include <cmath>

namespace chiaro::renderer {
namespace {

struct Tap {
  int source;
  float weight;
};

// What the pixel `target` of `to` pixels takes of `from` pixels; adds up to 1.
std::vector<Tap> taps_of(int target, int from, int to) {
  const double scale = double(from) / to, radius = std::max(1.0, scale);
  const double center = (target + 0.5) * scale - 0.5;
  std::vector<Tap> taps;
  double sum = 0;
  for (int i = int(std::ceil(center - radius)); i <= int(std::floor(center + radius)); ++i) {
    const double weight = 1 - std::abs(i - center) / radius;
    if (!(weight > 0)) continue;
    taps.push_back({std::clamp(i, 0, from - 1), float(weight)});
    sum += weight;
  }
  for (Tap& tap : taps) tap.weight /= float(sum);
  return taps;
}

void add_scaled(const float* pixel, float weight, std::size_t channels, float* sum) {
  for (std::size_t c = 0; c < channels; ++c) sum[c] += weight * pixel[c];
}

}  // namespace

Image resize(const Image& image, int width, int height) {
  const std::size_t channels = image.channel_names.size();
  Image wide = make_image(width, image.height, image.channel_names);
  for (int x = 0; x < width; ++x) {
    for (const Tap& tap : taps_of(x, image.width, width)) {
      for (int y = 0; y < image.height; ++y) {
        add_scaled(image.at(tap.source, y), tap.weight, channels, wide.at(x, y));
      }
    }
  }
  Image resized = make_image(width, height, image.channel_names);
  for (int y = 0; y < height; ++y) {
    for (const Tap& tap : taps_of(y, image.height, height)) {
      add_scaled(wide.at(0, tap.source), tap.weight, channels * std::size_t(width), resized.at(0, y));
    }
  }
  return resized;
}

}  // namespace chiaro::renderer
