#include "renderer/trace/render.h"

#include "renderer/core/error.h"
#include "renderer/core/seconds_since.h"
#include "renderer/trace/camera_rays.h"
#include "renderer/trace/film.h"
#include "renderer/trace/path_tracer.h"
#include "renderer/trace/pixel_filter.h"

namespace chiaro::renderer {
namespace {

struct FrameTask {
  const RayTracer& tracer;
  const PathTracer& paths;
  const CameraRays& rays;
  const PixelFilter& filter;
  const RenderOptions& options;
};

// Light of the light sources that the camera sees by itself goes to the layer of the emissive surfaces.
void add_emission(const SurfacePoint& point, std::size_t source, PixelSample& sample) {
  sample.light.add(0, source, point.emission);
}

PixelSample sample_pixel(const FrameTask& task, int x, int y, std::uint32_t index, const Film& film) {
  Sampler sampler(task.options.trace.seed, std::uint32_t(y) * std::uint32_t(task.options.width) + std::uint32_t(x),
                  index);
  const Vec2f offset = task.filter.sample(sampler.next_2d());
  Ray ray = task.rays.at({float(x) + 0.5F + offset.x, float(y) + 0.5F + offset.y});
  ray.alpha_seed = sampler.next_bits();
  PixelSample sample;
  sample.light.per_light.assign(film.light_layers(), Vec3f{});
  const auto hit = task.tracer.intersect(ray);
  if (!hit) return sample;
  const SurfacePoint point = make_surface_point(task.tracer.scene(), ray, *hit);
  sample.hit = true;
  sample.albedo = point.base_color;
  sample.normal = point.shading_normal;
  sample.position = point.position;
  sample.depth = hit->distance;
  add_emission(point, task.paths.emission_source(), sample);
  task.paths.add_scattered(point, -ray.direction, 0, {1, 1, 1}, sampler, sample.light);
  sample.beauty = sample.light.direct + sample.light.indirect;
  if (film.wants_illumination()) {
    PathLight light;
    task.paths.add_illumination(point, sampler, light);
    sample.illumination = light.direct + light.indirect;
  }
  return sample;
}

// Samples first … last−1 of every pixel, a row at a time.
void add_samples(const FrameTask& task, int first, int last, const Control& control, Film& film) {
  parallel_for(std::size_t(task.options.height), "render", control, [&](std::size_t row) {
    for (int x = 0; x < task.options.width; ++x) {
      if (control.stop_requested()) throw Interruption();
      for (int i = first; i < last; ++i) {
        film.add(x, int(row), sample_pixel(task, x, int(row), std::uint32_t(i), film));
      }
    }
  });
}

// Progress of one pass as progress of the whole frame.
Control share_of(const Control& control, double begin, double end) {
  Control part = control;
  if (control.report) {
    part.report = [&control, begin, end](std::string_view stage, double f) {
      control.report(stage, begin + f * (end - begin));
    };
  }
  return part;
}

}  // namespace

Frame render(const RayTracer& tracer, const Camera& camera, const Lights& lights, const RenderOptions& options,
             const Control& control) {
  const auto start = std::chrono::steady_clock::now();
  const PathTracer paths(tracer, lights, options.trace.bounces, options.trace.scene_emission);
  const CameraRays rays(camera, options.width, options.height);
  const PixelFilter filter = options.box_filter ? PixelFilter::box() : PixelFilter::blackman_harris();
  const FrameTask task{tracer, paths, rays, filter, options};
  Film film(options.width, options.height, options.layers, lights);
  const int samples = options.trace.samples;
  const int pass = options.time_limit > 0 ? std::min(samples, 4) : samples;
  Frame frame;
  while (frame.samples < samples) {
    const int last = std::min(samples, frame.samples + pass);
    add_samples(task, frame.samples, last, share_of(control, double(frame.samples) / samples, double(last) / samples),
                film);
    frame.samples = last;
    const double spent = seconds_since(start);
    // Another pass only if it is expected to end in time.
    if (options.time_limit > 0 && spent * (frame.samples + pass) / frame.samples > options.time_limit) break;
  }
  frame.image = film.finish(frame.samples, frame.relative_standard_error);
  frame.seconds = seconds_since(start);
  return frame;
}

Camera default_camera(const Scene& scene) {
  const Box3f box = bounds(scene);
  Camera camera;
  camera.name = "default";
  const Vec3f backward = normalize(Vec3f{0.6F, 0.45F, 1.0F});
  const float distance = 0.6F * box.diagonal() / std::tan(0.5F * camera.vertical_fov);
  const Vec3f right = normalize(cross({0, 1, 0}, backward)), up = cross(backward, right);
  const Vec3f eye = box.center() + distance * backward;
  const Vec3f columns[4] = {right, up, backward, eye};
  for (int c = 0; c < 4; ++c) {
    for (int row = 0; row < 3; ++row) camera.world_from_camera(row, c) = columns[c][row];
  }
  camera.near = 1e-4F * distance;
  return camera;
}

}  // namespace chiaro::renderer
