#include "inverse/target/illumination_picture.h"

#include <optional>

#include "inverse/target/receiver_lookup.h"
#include "renderer/core/error.h"
#include "renderer/core/sampler.h"
#include "renderer/trace/camera_rays.h"
#include "renderer/trace/path_tracer.h"
#include "renderer/trace/surface_point.h"

namespace chiaro::inverse {
namespace {

constexpr int kGrid = 2;              // samples along a side of a pixel …
constexpr int kGridOfBlended = 4;     // … where half-transparent surfaces are seen by some of them alone
constexpr float kMostlyKnown = 0.5F;  // of the weights of a triangle's corners, those that the target weighs, or more

class IlluminationView {
 public:
  IlluminationView(const renderer::RayTracer& tracer, const Target& target, const PictureFrame& frame)
      : tracer_(tracer),
        target_(target),
        lookup_(target.receivers),
        rays_(frame.camera, frame.width, frame.height),
        grid_(renderer::has_blended_surfaces(tracer.scene()) ? kGridOfBlended : kGrid) {}

  void write_pixel(int x, int y, float* pixel) const {
    const auto part = 1 / float(grid_ * grid_);
    for (int i = 0; i < grid_ * grid_; ++i) {
      const renderer::Vec2f in_pixel{(float(i % grid_) + 0.5F) / float(grid_),
                                     (float(i / grid_) + 0.5F) / float(grid_)};
      const std::uint32_t of_pixel = renderer::hash_combine(std::uint32_t(x), std::uint32_t(y));
      const auto value =
          seen({float(x) + in_pixel.x, float(y) + in_pixel.y}, renderer::hash_combine(of_pixel, std::uint32_t(i)));
      if (!value) continue;
      for (int c = 0; c < 3; ++c) pixel[c] += part * (*value)[c];
      pixel[3] += part;
    }
  }

 private:
  // seed: of what half-transparent surfaces let through.
  std::optional<Vec3f> seen(renderer::Vec2f film, std::uint32_t seed) const {
    renderer::Ray ray = rays_.at(film);
    ray.alpha_seed = seed;
    ray.of_camera = true;
    const auto hit = tracer_.intersect(ray);
    if (!hit) return std::nullopt;
    const renderer::SurfacePoint point = make_surface_point(tracer_.scene(), ray, *hit);
    const auto at = lookup_.find(point.position, point.geometric_normal);
    return at ? known(*at) : std::nullopt;
  }

  std::optional<Vec3f> known(const ReceiverWeights& at) const {
    Vec3f sum;
    float weights = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(target_.weight[at.receivers[k]] > 0)) continue;
      sum += at.weights[k] * target_.illumination[at.receivers[k]];
      weights += at.weights[k];
    }
    if (weights < kMostlyKnown) return std::nullopt;
    return sum / weights;
  }

  const renderer::RayTracer& tracer_;
  const Target& target_;
  ReceiverLookup lookup_;
  renderer::CameraRays rays_;
  int grid_;
};

}  // namespace

renderer::Image illumination_picture(const renderer::RayTracer& tracer, const Target& target, const PictureFrame& frame,
                                     const renderer::Control& control) {
  CHIARO_CHECK(target.illumination.size() == target.receivers.size());
  CHIARO_CHECK(target.weight.size() == target.receivers.size());
  const IlluminationView view(tracer, target, frame);
  renderer::Image image = renderer::make_image(frame.width, frame.height, {"R", "G", "B", "A"});
  renderer::parallel_for(std::size_t(frame.height), "picturing illumination", control, [&](std::size_t y) {
    for (int x = 0; x < frame.width; ++x) view.write_pixel(x, int(y), image.at(x, int(y)));
  });
  return image;
}

}  // namespace chiaro::inverse
