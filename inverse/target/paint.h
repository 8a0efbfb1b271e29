#pragma once
// The illumination brush.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "inverse/target/target.h"

namespace chiaro::inverse {

enum class BrushMode : std::uint8_t { kAdd, kSet, kMultiply, kErase };
enum class BrushFalloff : std::uint8_t { kSmooth, kHard, kGaussian };
// How far a receiver is from the path: along the surface, or straight through space.
enum class BrushDistance : std::uint8_t { kSurface, kSpace };

struct MirrorPlane {
  Vec3f point;   // metres
  Vec3f normal;  // unit
};

struct Stroke {
  BrushMode mode = BrushMode::kAdd;
  Vec3f color;          // cd/m²; kMultiply: factors
  float radius = 0.3F;  // metres
  BrushFalloff falloff = BrushFalloff::kSmooth;
  float opacity = 1;
  std::vector<Vec3f> path;  // metres, on the surface
  BrushDistance distance = BrushDistance::kSurface;
  std::optional<MirrorPlane> mirror = {};  // the path's mirror image belongs to it
  bool facing = true;  // touch only receivers that face the side the stroke was painted from, fading
  float weight = 1;    // given to the receivers touched, as far as they face it
};

enum class StrokeBase : std::uint8_t { kBlack, kCurrent };

struct Strokes {
  StrokeBase base = StrokeBase::kBlack;
  std::vector<Stroke> strokes;
};

// JSON as in docs/strokes.md; Error naming the stroke and the field.
Strokes load_strokes(const std::filesystem::path& path);

struct PaintOptions {
  std::optional<float> unpainted_weight = 0.05F;  // where no stroke touches; absent: the base's weights
};

struct PaintResult {
  Target target;
  std::vector<std::size_t> touched;  // receivers per stroke
  // Per stroke: points of its path farther than its radius from any surface, and those whose mirror images are.
  std::vector<std::vector<std::size_t>> far_points, far_images;
};

// Applies the strokes in order to `base`: its illumination is what they change, and unpainted_weight, or else its own
// weights, what they bring nearer to theirs. Values are held between 0 and renderer::kBrightest. control: to be
// interrupted.
PaintResult paint(const Target& base, const Strokes& strokes, const PaintOptions& options,
                  const renderer::Control& control = {});

}  // namespace chiaro::inverse
