// How long a bake takes, beside what it is measured by: Embree's own rate on the same shadow rays, the direct part, and
// path tracing each light to the same noise.
//   bake_benchmark SCENE.glb [X,Y,Z [RECEIVERS [SAMPLES]]]     a grid of lights; all receivers unless so many are asked

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "inverse/transport/bake.h"
#include "renderer/core/seconds_since.h"
#include "renderer/io/load_gltf.h"

namespace {

using namespace chiaro;
using namespace chiaro::inverse;
using renderer::parallel_for;
using renderer::RayTracer;
using renderer::Scene;
using renderer::seconds_since;

constexpr std::size_t kRawLights = 64, kTracedLights = 16, kThin = 7;
constexpr int kTracedSamples = 8;

std::chrono::steady_clock::time_point now() { return std::chrono::steady_clock::now(); }

// The scene's triangles as Embree has them with the ray tracer's settings, without anything of ours around it.
class RawScene {
 public:
  explicit RawScene(const Scene& scene) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    for (const renderer::Instance& instance : scene.instances) {
      const renderer::Mesh& mesh = scene.meshes[instance.mesh];
      RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* positions = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.positions.size()));
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        positions[i] = transform_point(instance.world_from_object, mesh.positions[i]);
      }
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                                 sizeof(renderer::Triangle), mesh.triangles.size());
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
  }
  ~RawScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  RawScene(const RawScene&) = delete;
  RawScene& operator=(const RawScene&) = delete;

  // Rays a second, on all threads: those of a bake's direct part of some of its lights, made before the clock starts.
  double rate(const Receivers& receivers, const std::vector<Vec3f>& lights) const {
    double seconds = 0;
    std::size_t rays = 0;
    for (std::size_t k = 0; k < kRawLights; ++k) {
      std::vector<RTCRay> queries = rays_to(receivers, lights[k * lights.size() / kRawLights]);
      constexpr std::size_t kBlock = 256;
      const auto start = now();
      parallel_for((queries.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (std::size_t i = block * kBlock; i < std::min(queries.size(), (block + 1) * kBlock); ++i) {
          rtcOccluded1(scene_, &context, &queries[i]);
        }
      });
      seconds += seconds_since(start);
      rays += queries.size();
    }
    return double(rays) / seconds;
  }

 private:
  static std::vector<RTCRay> rays_to(const Receivers& receivers, Vec3f light) {
    std::vector<RTCRay> rays;
    for (const renderer::SurfaceSample& at : receivers.samples) {
      if (dot(light - at.position, at.normal) <= 0) continue;
      const renderer::Ray ray = renderer::ray_between(renderer::offset_point(at.position, at.normal), light, 0);
      RTCRay r{};
      r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
      r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
      r.tfar = ray.far, r.mask = ~0U;
      rays.push_back(r);
    }
    return rays;
  }

  RTCDevice device_;
  RTCScene scene_;
};

struct Baked {
  BakeSummary summary;
  double seconds = 0, error = 0;
  std::vector<Vec3f> indirect;  // of some entries
  std::vector<std::uint32_t> light;
};

Baked bake_once(const RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                const BakeSettings& settings) {
  Baked baked;
  const auto start = now();
  Baker baker(tracer, receivers, grid, settings, std::numeric_limits<double>::infinity());
  const auto keep_some = [&](const TransportBlock& block) {
    for (std::size_t i = block.first_light % kThin; i < block.indirect.size(); i += kThin) {
      baked.indirect.push_back(block.indirect[i]);
      baked.light.push_back(std::uint32_t(block.first_light + i / block.receiver_count));
    }
  };
  baker.bake(0, receivers.size(), {}, keep_some, {});
  baked.summary = baker.summary();
  baked.seconds = seconds_since(start) - baked.summary.check_seconds;
  baked.error = baker.header().indirect_relative_error;
  return baked;
}

struct Noise {
  double all = 0, median = 0, ninetieth = 0;  // relative L2, of all entries and of single lights
};

// Of either of two bakes that differ by their seed.
Noise noise_of(const Baked& a, const Baked& b, std::size_t lights) {
  std::vector<double> difference(lights, 0), value(lights, 0), relative;
  for (std::size_t i = 0; i < a.indirect.size(); ++i) {
    difference[a.light[i]] += double(length_squared(a.indirect[i] - b.indirect[i])) / 2;
    value[a.light[i]] += double(length_squared(a.indirect[i]));
  }
  for (std::size_t l = 0; l < lights; ++l) relative.push_back(value[l] > 0 ? std::sqrt(difference[l] / value[l]) : 0);
  std::sort(relative.begin(), relative.end());
  const auto sum = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
  return {std::sqrt(sum(difference) / sum(value)), relative[lights / 2], relative[lights * 9 / 10]};
}

// Seconds that path tracing takes for the indirect light of one light to a relative standard error.
double seconds_per_light(const RayTracer& tracer, const Receivers& receivers, const std::vector<Vec3f>& lights,
                         double error) {
  double variance = 0, value = 0, seconds = 0;
  for (const std::size_t light : evenly_spread(lights.size(), kTracedLights)) {
    const renderer::Lights unity{renderer::PointLight{"", lights[light], {1, 1, 1}}};
    renderer::TraceOptions options{kTracedSamples, -1, light, false};
    const auto start = now();
    const auto all = renderer::trace_illumination(tracer, receivers.samples, unity, options, {});
    seconds += seconds_since(start) / kTracedLights;
    options.bounces = 0;
    const auto direct = renderer::trace_illumination(tracer, receivers.samples, unity, options, {});
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      variance += double(length_squared(all.standard_error[i]));
      value += double(length_squared(all.value[i] - direct.value[i]));
    }
  }
  std::printf("path tracing          %d samples: %.3f s a light, noise of indirect %.2f %%\n", kTracedSamples, seconds,
              100 * std::sqrt(variance / value));
  return seconds * variance / value / (error * error);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::puts("bake_benchmark SCENE.glb [X,Y,Z [RECEIVERS [SAMPLES]]]");
    return 2;
  }
  const renderer::LoadedScene loaded = renderer::load_gltf(argv[1]);
  const RayTracer tracer(loaded.scene);
  LightGridOptions grid_options;
  grid_options.counts = {16, 16, 16};
  if (argc > 2) {
    std::sscanf(argv[2], "%d,%d,%d", &grid_options.counts[0], &grid_options.counts[1], &grid_options.counts[2]);
  }
  const LightGrid grid = make_light_grid(tracer, grid_options);
  Receivers receivers = make_receivers(loaded.scene, {});
  if (argc > 3 && std::atoi(argv[3]) > 0) {
    receivers = select_receivers(receivers, evenly_spread(receivers.size(), std::size_t(std::atoi(argv[3]))));
  }
  BakeSettings settings{.samples = argc > 4 ? std::atoi(argv[4]) : 256, .bounces = -1, .seed = 0, .materials = "gltf"};

  const double raw = RawScene(loaded.scene).rate(receivers, grid.positions);
  const Baked baked = bake_once(tracer, receivers, grid, settings);
  const double rate = double(baked.summary.shadow_rays) / baked.summary.direct_seconds;
  settings.seed = 1;
  const Baked other = bake_once(tracer, receivers, grid, settings);
  const Noise noise = noise_of(baked, other, grid.positions.size());
  std::printf("%zu receivers x %zu lights, %d threads\n", receivers.size(), grid.positions.size(),
              renderer::thread_count());
  std::printf("direct                %.2f s, %.1f M rays/s; Embree alone %.1f: %.0f %%\n", baked.summary.direct_seconds,
              rate / 1e6, raw / 1e6, 100 * rate / raw);
  std::printf("whole bake            %.2f s: %.2f x direct; %zu gather points, %zu records\n", baked.seconds,
              baked.seconds / baked.summary.direct_seconds, baked.summary.gather_points, baked.summary.records);
  std::printf("noise of indirect     %.2f %%; of a light %.2f %% (median), %.2f %% (90th percentile)\n",
              100 * noise.all, 100 * noise.median, 100 * noise.ninetieth);
  std::printf("against path tracer   %.2f %%\n", 100 * baked.error);
  const double traced = seconds_per_light(tracer, receivers, grid.positions, noise.all) * double(grid.positions.size());
  std::printf("path tracing all      %.0f s to that noise: %.0f x the whole bake\n", traced, traced / baked.seconds);
  return 0;
}
