#include "inverse/target/paint.h"

#include <algorithm>
#include <cmath>

#include "inverse/target/brush_footprint.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

// Of the distance in radii, 0 to 1; 1 at the path.
float falloff(BrushFalloff kind, float x) {
  switch (kind) {
    case BrushFalloff::kHard:
      return 1;
    case BrushFalloff::kSmooth:
      return 1 - x * x * (3 - 2 * x);
    case BrushFalloff::kGaussian:
      break;
  }
  // The radius is three standard deviations; shifted and scaled, so that it ends at 0 there without a rim.
  const float rim = std::exp(-4.5F);
  return std::max(0.0F, (std::exp(-4.5F * x * x) - rim) / (1 - rim));
}

// What a brush does to a value: gain · value + offset.
struct Change {
  Vec3f gain, offset;
};

Change brush_change(const Stroke& stroke, float strength) {
  const Vec3f one{1, 1, 1};
  switch (stroke.mode) {
    case BrushMode::kAdd:
      return {one, strength * stroke.color};
    case BrushMode::kSet:
      return {(1 - strength) * one, strength * stroke.color};
    case BrushMode::kMultiply:
      return {lerp(strength, one, stroke.color), {}};
    case BrushMode::kErase:
      break;
  }
  return {(1 - strength) * one, {}};
}

Vec3f apply(const Change& change, Vec3f value) {
  const Vec3f changed = change.gain * value + change.offset;
  constexpr float kMost = renderer::kBrightest;
  return {std::clamp(changed.x, 0.0F, kMost), std::clamp(changed.y, 0.0F, kMost), std::clamp(changed.z, 0.0F, kMost)};
}

// Of a standard error, root mean square over the channels.
float left_of(float error, Vec3f gain) {
  const double left = double(error) * std::sqrt(squared_norm(gain) / 3);
  return float(std::min(left, double(renderer::kBrightest)));
}

void apply_to_receiver(Target& target, const Stroke& stroke, const TouchedReceiver& touched) {
  const float strength = stroke.opacity * touched.facing * falloff(stroke.falloff, touched.distance / stroke.radius);
  const Change change = brush_change(stroke, strength);
  const std::size_t i = touched.receiver;
  target.illumination[i] = apply(change, target.illumination[i]);
  target.weight[i] = std::lerp(target.weight[i], stroke.weight, touched.facing);
  // Paint is free of noise: of a traced value's error only what the gain leaves stays.
  if (!target.standard_error.empty()) target.standard_error[i] = left_of(target.standard_error[i], change.gain);
}

void check_options(const PaintOptions& options) {
  const float weight = options.unpainted_weight.value_or(0);
  if (std::isfinite(weight) && weight >= 0) return;
  throw renderer::Error({"", "option --unpainted-weight", "is negative or not finite", "a number ≥ 0"});
}

}  // namespace

PaintResult paint(const Target& base, const Strokes& strokes, const PaintOptions& options,
                  const renderer::Control& control) {
  check_options(options);
  CHIARO_CHECK(base.illumination.size() == base.receivers.size());
  PaintResult result{base, {}, {}, {}};
  if (options.unpainted_weight) result.target.weight.assign(base.receivers.size(), *options.unpainted_weight);
  CHIARO_CHECK(result.target.weight.size() == base.receivers.size());
  const ReceiverSurface surface = make_receiver_surface(base.receivers);
  for (const Stroke& stroke : strokes.strokes) {
    CHIARO_CHECK(stroke.radius > 0 && !stroke.path.empty());
    BrushFootprint footprint = brush_footprint(surface, stroke, control);
    for (const TouchedReceiver& touched : footprint.touched) apply_to_receiver(result.target, stroke, touched);
    result.touched.push_back(footprint.touched.size());
    result.far_points.push_back(std::move(footprint.far_points));
    result.far_images.push_back(std::move(footprint.far_images));
  }
  return result;
}

}  // namespace chiaro::inverse
