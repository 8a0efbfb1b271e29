#include "renderer/image/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/core/vec.h"
#include "renderer/image/separable_filter.h"
#include "renderer/image/srgb_curve.h"

// Notation, as published:
//   p           pixels per degree
//   Y Cx Cz     opponent space, linear in X, Y, Z: achromatic, red-green, blue-yellow
//   L a b       CIELAB, a and b adjusted by Hunt
//   ΔEc ΔEf     differences of colour and of features, 0 to 1
//   g           Gaussians: of the contrast sensitivity (a, b below), and of the features' width w

namespace chiaro::renderer {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kColorExponent = 0.7F;    // qc
constexpr float kColorShare = 0.4F;       // pc: differences below this share of the largest …
constexpr float kColorTarget = 0.95F;     // pt: … fill this part of 0 to 1
constexpr double kFeatureWidth = 0.082;   // w, degrees
constexpr float kFeatureExponent = 0.5F;  // qf
constexpr std::size_t kPixelsPerTask = 4096;

struct SensitivityGaussian {
  double a, b;  // a √(π/b) exp(−π² x² / b), x in degrees
};

constexpr SensitivityGaussian kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053};
constexpr SensitivityGaussian kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};

template <class Body>
void for_each_pixel(std::size_t count, const Body& body) {
  parallel_for((count + kPixelsPerTask - 1) / kPixelsPerTask, [&](std::size_t task) {
    const std::size_t end = std::min(count, (task + 1) * kPixelsPerTask);
    for (std::size_t i = task * kPixelsPerTask; i < end; ++i) body(i);
  });
}

// IEC 61966-2-1.
Vec3f xyz_of(Vec3f c) {
  return {0.4124564F * c.x + 0.3575761F * c.y + 0.1804375F * c.z,
          0.2126729F * c.x + 0.7151522F * c.y + 0.0721750F * c.z,
          0.0193339F * c.x + 0.1191920F * c.y + 0.9503041F * c.z};
}

Vec3f linear_of_xyz(Vec3f c) {
  return {3.2404542F * c.x - 1.5371385F * c.y - 0.4985314F * c.z,
          -0.9692660F * c.x + 1.8760108F * c.y + 0.0415560F * c.z,
          0.0556434F * c.x - 0.2040259F * c.y + 1.0572252F * c.z};
}

const Vec3f kWhite = xyz_of({1, 1, 1});

// Y Cx Cz, or L a b where the X, Y, Z have gone through CIELAB's curve.
Vec3f opponent_of(Vec3f relative_xyz) {
  return {116 * relative_xyz.y - 16, 500 * (relative_xyz.x - relative_xyz.y), 200 * (relative_xyz.y - relative_xyz.z)};
}

Vec3f relative_xyz_of(Vec3f opponent) {
  const float y = (opponent.x + 16) / 116;
  return {y + opponent.y / 500, y, y - opponent.z / 200};
}

float cielab_curve(float t) {
  constexpr float kDelta = 6.0F / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0F / 29;
}

// Hunt: colours of dark pixels are seen less.
Vec3f adjusted_lab(Vec3f linear) {
  const Vec3f t = xyz_of(linear) / kWhite;
  const Vec3f lab = opponent_of({cielab_curve(t.x), cielab_curve(t.y), cielab_curve(t.z)});
  return {lab.x, 0.01F * lab.x * lab.y, 0.01F * lab.x * lab.z};
}

float euclidean(float x, float y) { return std::sqrt(x * x + y * y); }

// HyAB: city block in lightness, Euclidean in chroma.
float hyab(Vec3f a, Vec3f b) { return std::abs(a.x - b.x) + euclidean(a.y - b.y, a.z - b.z); }

const float kLargestDifference = std::pow(hyab(adjusted_lab({0, 1, 0}), adjusted_lab({0, 0, 1})), kColorExponent);

// Section 4.1, the redistribution of large differences.
float color_difference(Vec3f lab_a, Vec3f lab_b) {
  const float difference = std::pow(hyab(lab_a, lab_b), kColorExponent);
  const float knee = kColorShare * kLargestDifference;
  if (difference < knee) return kColorTarget / knee * difference;
  return kColorTarget + (difference - knee) / (kLargestDifference - knee) * (1 - kColorTarget);
}

float clamped(float value) { return value > 0 ? std::min(value, 1.0F) : 0; }
Vec3f clamped(Vec3f c) { return {clamped(c.x), clamped(c.y), clamped(c.z)}; }

using Planes = std::array<Plane, 3>;

Planes opponent_planes(const Image& linear) {
  const std::size_t count = std::size_t(linear.width) * std::size_t(linear.height);
  Planes planes;
  for (Plane& plane : planes) plane = {linear.width, linear.height, std::vector<float>(count)};
  for_each_pixel(count, [&](std::size_t i) {
    const float* rgb = &linear.pixels[3 * i];
    const Vec3f opponent = opponent_of(xyz_of(clamped(Vec3f{rgb[0], rgb[1], rgb[2]})) / kWhite);
    for (int c = 0; c < 3; ++c) planes[std::size_t(c)].values[i] = opponent[c];
  });
  return planes;
}

template <class Function>
FilterWeights make_weights(int radius, const Function& weight) {
  FilterWeights weights;
  for (int x = -radius; x <= radius; ++x) weights.push_back(float(weight(double(x))));
  return weights;
}

float sum_of(const FilterWeights& weights) {
  double sum = 0;
  for (const float weight : weights) sum += double(weight);
  return float(sum);
}

FilterWeights scaled(FilterWeights weights, float factor) {
  for (float& weight : weights) weight *= factor;
  return weights;
}

FilterWeights sensitivity_weights(double b, double p) {
  const double largest = kBlueYellow[0].b;
  const int radius = int(std::ceil(3 * std::sqrt(largest / (2 * kPi * kPi)) * p));
  return make_weights(radius, [&](double x) { return std::exp(-kPi * kPi * (x / p) * (x / p) / b); });
}

Plane filtered(const Plane& plane, const FilterWeights& along_rows, const FilterWeights& along_columns) {
  return filter_columns(filter_rows(plane, along_rows), along_columns);
}

Plane filter_by_sensitivity(const Plane& plane, const SensitivityGaussian& gaussian, double p) {
  const FilterWeights weights = sensitivity_weights(gaussian.b, p);
  const FilterWeights normalized = scaled(weights, 1 / sum_of(weights));
  return filtered(plane, normalized, normalized);
}

// Each of the two Gaussians is a product, their sum is not.
Plane filter_blue_yellow(const Plane& plane, double p) {
  FilterWeights weights[2];
  float volume[2];
  for (int i = 0; i < 2; ++i) {
    weights[i] = sensitivity_weights(kBlueYellow[i].b, p);
    const float height = float(kBlueYellow[i].a * std::sqrt(kPi / kBlueYellow[i].b));
    volume[i] = height * sum_of(weights[i]) * sum_of(weights[i]);
    weights[i] = scaled(weights[i], std::sqrt(height));
  }
  const float normalization = 1 / std::sqrt(volume[0] + volume[1]);
  for (FilterWeights& each : weights) each = scaled(each, normalization);
  Plane sum = filtered(plane, weights[0], weights[0]);
  const Plane second = filtered(plane, weights[1], weights[1]);
  for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += second.values[i];
  return sum;
}

Planes as_seen(const Planes& opponent, double p) {
  return {filter_by_sensitivity(opponent[0], kAchromatic, p), filter_by_sensitivity(opponent[1], kRedGreen, p),
          filter_blue_yellow(opponent[2], p)};
}

Vec3f lab_at(const Planes& opponent, std::size_t i) {
  const Vec3f xyz = relative_xyz_of({opponent[0].values[i], opponent[1].values[i], opponent[2].values[i]}) * kWhite;
  return adjusted_lab(clamped(linear_of_xyz(xyz)));
}

// Weights above 0 add up to 1, those below to −1. Where pixels are too large for a feature there are none.
FilterWeights balanced(FilterWeights weights) {
  float positive = 0, negative = 0;
  for (const float weight : weights) (weight > 0 ? positive : negative) += weight;
  for (float& weight : weights) {
    if (weight != 0) weight /= weight > 0 ? positive : -negative;
  }
  return weights;
}

struct Gradient {
  Plane dx, dy;
};

struct Features {
  Gradient edges, points;
};

Features features_of(const Plane& achromatic, double p) {
  const double deviation = 0.5 * kFeatureWidth * p;
  const int radius = int(std::ceil(3 * deviation));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const FilterWeights first = balanced(make_weights(radius, [&](double x) { return -x * gauss(x); }));
  const FilterWeights second =
      balanced(make_weights(radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gauss(x); }));
  const FilterWeights raw = make_weights(radius, gauss), smooth = scaled(raw, 1 / sum_of(raw));
  const Plane rows = filter_rows(achromatic, smooth);
  return {{filtered(achromatic, first, smooth), filter_columns(rows, first)},
          {filtered(achromatic, second, smooth), filter_columns(rows, second)}};
}

float length_at(const Gradient& gradient, std::size_t i) {
  return euclidean(gradient.dx.values[i], gradient.dy.values[i]);
}

float feature_difference(const Features& a, const Features& b, std::size_t i) {
  const float edges = std::abs(length_at(a.edges, i) - length_at(b.edges, i));
  const float points = std::abs(length_at(a.points, i) - length_at(b.points, i));
  return std::pow(std::max(edges, points) / std::numbers::sqrt2_v<float>, kFeatureExponent);
}

// (Y + 16) / 116, 0 to 1.
Features luminance_features(Plane achromatic, double p) {
  for (float& value : achromatic.values) value = (value + 16) / 116;
  return features_of(achromatic, p);
}

Image linear_of(const Image& display) {
  Image linear = display;
  for_each_pixel(linear.pixels.size(),
                 [&](std::size_t i) { linear.pixels[i] = linear_from_srgb(clamped(linear.pixels[i])); });
  return linear;
}

}  // namespace

Image flip(const Image& a, const Image& b, double pixels_per_degree, const Control& control) {
  return flip_of_linear(linear_of(a), linear_of(b), pixels_per_degree, control);
}

Image flip_of_linear(const Image& a, const Image& b, double pixels_per_degree, const Control& control) {
  CHIARO_CHECK(a.width == b.width && a.height == b.height && a.channel_count() == 3 && b.channel_count() == 3);
  Planes opponent_a = opponent_planes(a), opponent_b = opponent_planes(b);
  control.stop_if_requested();
  const Features features_a = luminance_features(opponent_a[0], pixels_per_degree);
  control.stop_if_requested();
  const Features features_b = luminance_features(opponent_b[0], pixels_per_degree);
  control.stop_if_requested();
  opponent_a = as_seen(opponent_a, pixels_per_degree);
  control.stop_if_requested();
  opponent_b = as_seen(opponent_b, pixels_per_degree);
  control.stop_if_requested();
  Image error = make_image(a.width, a.height, {"FLIP"});
  for_each_pixel(error.pixels.size(), [&](std::size_t i) {
    const float color = color_difference(lab_at(opponent_a, i), lab_at(opponent_b, i));
    error.pixels[i] = std::pow(color, 1 - feature_difference(features_a, features_b, i));
  });
  return error;
}

}  // namespace chiaro::renderer
