#include "renderer/trace/render.h"

#include <algorithm>

#include "renderer/core/error.h"
#include "renderer/core/seconds_since.h"
#include "renderer/trace/adaptive_sampling.h"
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
  const MatteIds& mattes;     // empty: not asked for
  const Media media;          // that the camera is inside of
  const Vec3f eye, backward;  // of the camera
};

// One sample of a batch of a pixel.
struct SampleKey {
  int x, y, batch;
  std::uint32_t index;
};

Sampler make_sampler(const RenderOptions& options, const SampleKey& key) {
  const std::uint64_t seed = seed_of_batch(options.trace.seed, std::uint64_t(key.batch));
  return Sampler(seed, std::uint32_t(key.y) * std::uint32_t(options.width) + std::uint32_t(key.x), key.index);
}

void reset(const RenderOptions& options, std::size_t light_layers, PixelSample& sample) {
  std::vector<Vec3f> per_light = std::move(sample.light.per_light);
  per_light.assign(light_layers, Vec3f{});
  sample = {};
  sample.light.per_light = std::move(per_light);
  sample.light.clamp_direct = options.clamp_direct;
  sample.light.clamp_indirect = options.clamp_indirect;
}

Ray camera_ray(const FrameTask& task, const SampleKey& key, Sampler& sampler) {
  const Vec2f offset = task.filter.sample(sampler.next_2d());
  const Vec2f lens = task.options.lens.radius > 0 ? sampler.next_2d() : Vec2f{0.5F, 0.5F};
  Ray ray = task.rays.at({float(key.x) + 0.5F + offset.x, float(key.y) + 0.5F + offset.y}, lens);
  ray.alpha_seed = sampler.next_bits();
  ray.of_camera = true;
  return ray;
}

void sample_pixel(const FrameTask& task, const SampleKey& key, const Film& film, PixelSample& sample) {
  Sampler sampler = make_sampler(task.options, key);
  const Ray ray = camera_ray(task, key, sampler);
  const auto hit = task.tracer.intersect(ray);
  if (!hit) {
    task.paths.add_background(normalize(ray.direction), task.media.transmittance(kInfinity), sample.light);
    sample.beauty = sample.light.direct;
    return;
  }
  const Scene& scene = task.tracer.scene();
  const SurfacePoint point = make_surface_point(scene, ray, *hit);
  sample.hit = true;
  sample.albedo = point.base_color;
  sample.normal = point.shading_normal;
  sample.position = point.position;
  sample.depth = dot(task.eye - point.position, task.backward);
  if (film.wants_mattes()) {
    sample.object = task.mattes.objects[hit->instance];
    sample.material = task.mattes.materials[scene.meshes[scene.instances[hit->instance].mesh].material];
  }
  const Vec3f through = task.media.transmittance(point, hit->distance);
  sample.light.add(0, task.paths.emission_source(), through * point.emission);
  task.paths.add_scattered(point, task.media, -ray.direction, 0, through, sampler, sample.light);
  sample.beauty = sample.light.direct + sample.light.indirect;
  if (film.wants_illumination()) {
    PathLight light;
    light.clamp_direct = task.options.clamp_direct;
    light.clamp_indirect = task.options.clamp_indirect;
    task.paths.add_illumination(point, task.media, sampler, light);
    sample.illumination = light.direct + light.indirect;
  }
}

bool is_finite(const PixelSample& s) {
  const auto& lights = s.light.per_light;
  return renderer::is_finite(s.beauty) && renderer::is_finite(s.illumination) && renderer::is_finite(s.normal) &&
         renderer::is_finite(s.position) && std::isfinite(s.depth) &&
         std::all_of(lights.begin(), lights.end(), [](Vec3f light) { return renderer::is_finite(light); });
}

// The samples that the plan asks of a tile, to the film.
void add_tile(const FrameTask& task, std::size_t tile, std::array<int, 2> asked, Film& film) {
  TileSums sums = film.make_sums(tile);
  const FilmTile& at = film.tile(tile);
  PixelSample sample;
  for (int pixel = 0; pixel < at.pixels(); ++pixel) {
    for (int batch = 0; batch < kBatches; ++batch) {
      const int first = film.batch_samples(batch, film.asked(tile)[batch & 1]);
      const int last = film.batch_samples(batch, asked[batch & 1]);
      for (int i = first; i < last; ++i) {
        reset(task.options, film.light_layers(), sample);
        const SampleKey key{at.x0 + pixel % at.width(), at.y0 + pixel / at.width(), batch, std::uint32_t(i)};
        sample_pixel(task, key, film, sample);
        if (!is_finite(sample)) {
          ++sums.dropped;
          reset(task.options, film.light_layers(), sample);
        }
        film.add(sums, pixel, batch, sample);
      }
    }
  }
  film.merge(tile, sums, asked);
}

void add_pass(const FrameTask& task, const PassPlan& plan, const Control& control, Film& film) {
  std::vector<std::size_t> tiles;
  for (std::size_t tile = 0; tile < plan.size(); ++tile) {
    if (plan[tile] != film.asked(tile)) tiles.push_back(tile);
  }
  parallel_for(tiles.size(), "render", control, [&](std::size_t i) { add_tile(task, tiles[i], plan[tiles[i]], film); });
}

bool every_pixel_has_samples(const Film& film) {
  for (std::size_t tile = 0; tile < film.tile_count(); ++tile) {
    if (film.tile_samples(tile) == 0) return false;
  }
  return true;
}

// Samples of all pixels that are taken already, and those that are still to come at most: of tiles that have not all.
struct Progress {
  double taken = 0, left = 0;
};

Progress progress_of(const Film& film, const PassPlan& plan, int samples) {
  Progress p;
  for (std::size_t tile = 0; tile < plan.size(); ++tile) {
    const double pixels = film.tile(tile).pixels(), taken = film.tile_samples(tile);
    p.taken += pixels * taken;
    if (plan[tile] != film.asked(tile)) p.left += pixels * (samples - taken);
  }
  return p;
}

class Clock {
 public:
  explicit Clock(double limit) : limit_(limit) {}
  double seconds() const { return seconds_since(start_); }
  double fraction() const { return limit_ > 0 ? seconds() / limit_ : 0; }
  // Whether `more` samples after `taken` ones are expected to end in time.
  bool allows(double more, double taken) const {
    return !(limit_ > 0) || !(taken > 0) || seconds() * (taken + more) / taken <= limit_;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double limit_;
};

// Progress of one pass of `cost` samples as progress of the whole frame.
Control share_of(const Control& control, const Clock& clock, const Progress& progress, double cost) {
  Control part = control;
  if (control.report) {
    part.report = [&control, &clock, progress, cost](std::string_view stage, double f) {
      const double done = (progress.taken + f * cost) / std::max(progress.taken + progress.left, 1.0);
      control.report(stage, std::max(done, clock.fraction()));
    };
  }
  return part;
}

// Passes until nothing is asked for, the time is spent, or the control asks to stop. Returns whether it did.
bool add_passes(const FrameTask& task, const Clock& clock, const Control& control, LightVisibility* visibility,
                Film& film) {
  const RenderOptions& options = task.options;
  for (;;) {
    const PassPlan plan = plan_pass(film, options.noise_threshold);
    const double cost = cost_of(film, plan);
    const Progress progress = progress_of(film, plan, options.trace.samples);
    if (cost == 0 || !clock.allows(cost, progress.taken)) return false;
    try {
      add_pass(task, plan, share_of(control, clock, progress, cost), film);
    } catch (const Interruption&) {
      if (!every_pixel_has_samples(film)) throw;
      return true;
    }
    if (visibility != nullptr) visibility->learn();
    const std::optional<double> noise = control.report_noise ? film.relative_standard_error() : std::nullopt;
    if (noise) control.report_noise(*noise);
  }
}

void count_samples(const Film& film, Frame& frame) {
  double sum = 0, pixels = 0;
  for (std::size_t tile = 0; tile < film.tile_count(); ++tile) {
    const int samples = film.tile_samples(tile);
    frame.samples = std::max(frame.samples, samples);
    sum += double(film.tile(tile).pixels()) * samples;
    pixels += film.tile(tile).pixels();
  }
  frame.mean_samples = sum / pixels;
}

}  // namespace

Frame render(const RayTracer& tracer, const Camera& camera, const Lights& lights, const RenderOptions& options,
             const Control& control) {
  const Clock clock(options.time_limit);
  std::optional<LightVisibility> visibility;
  const bool may_learn = lights.size() > LightSelection::kFew && lights.size() <= LightSelection::kWeighed;
  if (may_learn) visibility.emplace(tracer.bounds(), lights.size());
  LightVisibility* const learnt = visibility ? &*visibility : nullptr;
  const PathTracer paths(tracer, lights, options.trace, learnt);
  const CameraRays rays(camera, options.width, options.height, options.lens);
  const PixelFilter filter = options.box_filter ? PixelFilter::box() : PixelFilter::blackman_harris();
  Film film(options.width, options.height, options.layers, lights, options.trace.samples);
  const MatteIds mattes = film.wants_mattes() ? matte_ids(tracer.scene()) : MatteIds{};
  const Vec3f eye = transform_point(camera.world_from_camera, {0, 0, 0});
  const FrameTask task{tracer,
                       paths,
                       rays,
                       filter,
                       options,
                       mattes,
                       paths.media_at(eye),
                       eye,
                       normalize(camera.world_from_camera.column(2))};
  Frame frame;
  frame.image = film.blank();  // what memory does not hold is known before the samples are taken
  frame.interrupted = add_passes(task, clock, control, learnt, film);
  film.finish(frame.image);
  frame.lens = options.lens;
  if (film.wants_mattes()) frame.mattes = mattes_of(tracer.scene());
  frame.relative_standard_error = film.relative_standard_error();
  frame.dropped_samples = film.dropped();
  count_samples(film, frame);
  frame.seconds = clock.seconds();
  return frame;
}

Camera default_camera(const Scene& scene, float aspect_ratio) {
  const Box3f box = bounds(scene);
  Camera camera;
  camera.name = "default";
  const Vec3f backward = normalize(Vec3f{0.6F, 0.45F, 1.0F});
  const float distance = 0.6F * box.diagonal() / (std::tan(0.5F * camera.vertical_fov) * std::min(1.0F, aspect_ratio));
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
