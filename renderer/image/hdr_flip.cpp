#include "renderer/image/hdr_flip.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/vec.h"

namespace chiaro::renderer {
namespace {

// Narkowicz's fit of the ACES filmic curve, its exposure of 0.6 undone: (k0 x² + k1 x) / (k2 x² + k3 x + k4).
constexpr double kCurve[5] = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};
constexpr double kShown = 0.85;  // what the curve makes of the brightest pixel, and of the median

float tone_mapped(float x) {
  const double v = double(x);
  return float((kCurve[0] * v * v + kCurve[1] * v) / (kCurve[2] * v * v + kCurve[3] * v + kCurve[4]));
}

// The larger x with curve(x) = kShown.
double input_of_shown() {
  const double a = kCurve[0] - kShown * kCurve[2], b = kCurve[1] - kShown * kCurve[3], c = -kShown * kCurve[4];
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

float light_of(float value) { return std::isfinite(value) && value > 0 ? value : 0; }

std::vector<float> positive_luminances(const Image& image) {
  std::vector<float> luminances;
  for (std::size_t i = 0; i + 2 < image.pixels.size(); i += 3) {
    const float y =
        luminance({light_of(image.pixels[i]), light_of(image.pixels[i + 1]), light_of(image.pixels[i + 2])});
    if (y > 0) luminances.push_back(y);
  }
  return luminances;
}

// Of all `count` values, those not given being 0; of those given where that is 0.
float median(std::vector<float> positive, std::size_t count) {
  const std::size_t zeros = count - positive.size(), middle = count / 2;
  const std::size_t place = middle >= zeros ? middle - zeros : positive.size() / 2;
  std::nth_element(positive.begin(), positive.begin() + std::ptrdiff_t(place), positive.end());
  return positive[place];
}

// Fills start, stop and exposures.
void choose_exposures(const Image& reference, const Image& a, HdrFlip& result) {
  std::vector<float> luminances = positive_luminances(reference);
  if (luminances.empty()) luminances = positive_luminances(a);
  if (luminances.empty()) luminances = {1};
  const float brightest = *std::max_element(luminances.begin(), luminances.end());
  const std::size_t count = std::max(luminances.size(), reference.pixels.size() / 3);
  result.start = std::log2(input_of_shown() / double(brightest));
  result.stop = std::log2(input_of_shown() / double(median(std::move(luminances), count)));
  result.exposures = std::max(2, int(std::ceil(result.stop - result.start)));
}

Image shown_at(const Image& image, double exposure) {
  const double gain = std::exp2(exposure);  // may be more than a float holds
  Image shown = image;
  for (float& value : shown.pixels) value = tone_mapped(float(std::min(double(light_of(value)) * gain, 1e6)));
  return shown;
}

void keep_larger(const Image& error, Image& largest) {
  for (std::size_t i = 0; i < error.pixels.size(); ++i) {
    largest.pixels[i] = std::max(largest.pixels[i], error.pixels[i]);
  }
}

}  // namespace

HdrFlip hdr_flip(const Image& a, const Image& reference, double pixels_per_degree, const Control& control) {
  HdrFlip result;
  choose_exposures(reference, a, result);
  result.error = make_image(a.width, a.height, {"FLIP"});
  for (int i = 0; i < result.exposures; ++i) {
    control.stop_if_requested();
    if (control.report) control.report("FLIP", double(i) / result.exposures);
    const double exposure = result.start + (result.stop - result.start) * i / (result.exposures - 1);
    keep_larger(flip_of_linear(shown_at(a, exposure), shown_at(reference, exposure), pixels_per_degree, control),
                result.error);
  }
  return result;
}

}  // namespace chiaro::renderer
