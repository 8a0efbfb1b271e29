#include "inverse/target/painted_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"
#include "renderer/trace/bsdf.h"
#include "renderer/trace/camera_rays.h"
#include "renderer/trace/surface_point.h"

namespace chiaro::inverse {
namespace {

using renderer::Ray;
using renderer::RayTracer;
using renderer::SurfacePoint;

constexpr int kGrid = 3;             // rays along a side of a pixel; the middle one is where its value goes
constexpr float kDarkest = 0.02F;    // albedo, in each channel
constexpr float kLeastMatt = 0.5F;   // part of the albedo that is diffuse, or more
constexpr float kSmoothest = 0.2F;   // roughness of the surface under or over the diffuse part
constexpr float kSamePlane = 0.9F;   // cosine between normals within a pixel, or more
constexpr float kPlaneOffset = 3;    // pixels that a point may lie off the plane of the pixel's middle, or less
constexpr float kSameAlbedo = 1.5F;  // ratio of albedos within a pixel, or less

enum class PixelKind : std::uint8_t { kUsed, kMasked, kBackground, kEdge, kShiny, kDark, kInvalid };

std::optional<SurfacePoint> seen(const RayTracer& tracer, Ray ray) {
  ray.of_camera = true;
  const auto hit = tracer.intersect(ray);
  if (!hit) return std::nullopt;
  return make_surface_point(tracer.scene(), ray, *hit);
}

Vec3f diffuse_albedo(const SurfacePoint& point) {
  if (point.lambert) return point.base_color;
  const float transmission = point.layers ? point.layers->transmission : 0;
  return (1 - point.metallic) * (1 - transmission) * point.base_color;
}

bool has_sharp_reflection(const SurfacePoint& point) {
  if (point.lambert) return false;
  if (point.roughness < kSmoothest) return true;
  return point.layers && point.layers->clearcoat > 0 && point.layers->clearcoat_roughness < kSmoothest;
}

// Shows more than the light that falls on it.
bool is_shiny(const SurfacePoint& point) {
  if (point.unlit || max_component(point.emission) > 0 || has_sharp_reflection(point)) return true;
  return luminance(diffuse_albedo(point)) < kLeastMatt * luminance(hemispherical_albedo(point));
}

bool far_from(float a, float b) { return std::max(a, b) > kSameAlbedo * std::max(std::min(a, b), kDarkest); }

bool differs(const SurfacePoint& a, const SurfacePoint& b, float pixel_size) {
  if (dot(a.geometric_normal, b.geometric_normal) < kSamePlane) return true;
  if (std::abs(dot(b.position - a.position, a.geometric_normal)) > kPlaneOffset * pixel_size) return true;
  const Vec3f x = hemispherical_albedo(a), y = hemispherical_albedo(b);
  return a.material != b.material && (far_from(x.x, y.x) || far_from(x.y, y.y) || far_from(x.z, y.z));
}

struct Pixel {
  PixelKind kind = PixelKind::kUsed;
  SurfaceValue value;
};

class FrameReader {
 public:
  FrameReader(const RayTracer& tracer, const PaintedFrame& frame)
      : tracer_(tracer), frame_(frame), rays_(frame.camera, frame.width, frame.height) {}

  Pixel pixel(int x, int y) const {
    const std::size_t i = std::size_t(y) * std::size_t(frame_.width) + std::size_t(x);
    const Vec3f color = frame_.pixels[i];
    if (!(frame_.weight[i] > 0)) return {PixelKind::kMasked, {}};
    if (!is_finite(color) || min_component(color) < 0) return {PixelKind::kInvalid, {}};
    const auto middle = seen(tracer_, ray(x, y, kGrid / 2, kGrid / 2));
    if (!middle) return {PixelKind::kBackground, {}};
    if (frame_.content == PictureContent::kBeauty && is_shiny(*middle)) return {PixelKind::kShiny, {}};
    const auto albedo = albedo_of(x, y, *middle);
    if (!albedo) return {PixelKind::kEdge, {}};
    return value_of(color, *albedo, *middle, frame_.weight[i]);
  }

 private:
  Ray ray(int x, int y, int column, int row) const {
    Ray ray = rays_.at({float(x) + (float(column) + 0.5F) / kGrid, float(y) + (float(row) + 0.5F) / kGrid});
    // A pixel of a half-transparent surface and of what is behind it shows both, as an edge.
    ray.alpha_seed = std::uint32_t(kGrid * row + column);
    return ray;
  }

  // Width of a pixel where `point` is, metres, on a plane that faces the camera.
  float pixel_size(int x, int y, Vec3f point) const {
    const Ray left = rays_.at({float(x), float(y) + 0.5F}), right = rays_.at({float(x) + 1, float(y) + 0.5F});
    const float distance = length(point - left.origin);
    return length(right.origin + distance * right.direction - left.origin - distance * left.direction);
  }

  // Average over the pixel. None where it shows more than one surface.
  std::optional<Vec3f> albedo_of(int x, int y, const SurfacePoint& middle) const {
    const float size = pixel_size(x, y, middle.position);
    Vec3f sum = hemispherical_albedo(middle);
    for (int row = 0; row < kGrid; ++row) {
      for (int column = 0; column < kGrid; ++column) {
        if (row == kGrid / 2 && column == kGrid / 2) continue;
        const auto point = seen(tracer_, ray(x, y, column, row));
        if (!point || differs(middle, *point, size)) return std::nullopt;
        sum += hemispherical_albedo(*point);
      }
    }
    return sum / float(kGrid * kGrid);
  }

  Pixel value_of(Vec3f color, Vec3f albedo, const SurfacePoint& at, float weight) const {
    const bool is_beauty = frame_.content == PictureContent::kBeauty;
    if (is_beauty && min_component(albedo) < kDarkest) return {PixelKind::kDark, {}};
    const Vec3f illumination = is_beauty ? color / albedo : color;
    if (!renderer::is_light(illumination)) return {PixelKind::kInvalid, {}};
    return {PixelKind::kUsed, {at.position, at.geometric_normal, illumination, weight}};
  }

  const RayTracer& tracer_;
  const PaintedFrame& frame_;
  renderer::CameraRays rays_;
};

void count(PixelCounts& counts, PixelKind kind) {
  switch (kind) {
    case PixelKind::kUsed:
      ++counts.used;
      break;
    case PixelKind::kMasked:
      ++counts.masked;
      break;
    case PixelKind::kBackground:
      ++counts.background;
      break;
    case PixelKind::kEdge:
      ++counts.edge;
      break;
    case PixelKind::kShiny:
      ++counts.shiny;
      break;
    case PixelKind::kDark:
      ++counts.dark;
      break;
    case PixelKind::kInvalid:
      ++counts.invalid;
      break;
  }
}

}  // namespace

FrameValues values_of_frame(const RayTracer& tracer, const PaintedFrame& frame, const renderer::Control& control) {
  CHIARO_CHECK(frame.pixels.size() == std::size_t(frame.width) * std::size_t(frame.height));
  CHIARO_CHECK(frame.weight.size() == frame.pixels.size());
  const FrameReader reader(tracer, frame);
  std::vector<Pixel> pixels(frame.pixels.size());
  renderer::parallel_for(std::size_t(frame.height), "reading the picture", control, [&](std::size_t y) {
    for (int x = 0; x < frame.width; ++x) {
      pixels[y * std::size_t(frame.width) + std::size_t(x)] = reader.pixel(x, int(y));
    }
  });
  FrameValues result;
  for (const Pixel& pixel : pixels) {
    count(result.counts, pixel.kind);
    if (pixel.kind == PixelKind::kUsed) result.values.push_back(pixel.value);
  }
  return result;
}

}  // namespace chiaro::inverse
