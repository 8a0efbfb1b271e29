#include "renderer/trace/path_tracer.h"

#include <limits>

namespace chiaro::renderer {
namespace {

// From this vertex on a path survives with the probability of its throughput, at most kMostSurvival so that it ends
// among surfaces of albedo 1 too.
constexpr int kRouletteVertex = 3;
constexpr float kMostSurvival = 0.95F;

float balance_heuristic(float pdf, float other) { return pdf / (pdf + other); }

// Emission from no triangle at all, where the scene's own is not wanted.
const Scene& scene_without_emission() {
  static const Scene empty;
  return empty;
}

}  // namespace

// A surface that light is gathered at: either a material's, or a white receiver of which illumination is asked.
struct PathTracer::Vertex {
  Vec3f position;
  Vec3f normal;  // geometric; rays start on its side
  Vec3f to_viewer;
  const Bsdf* bsdf;  // nullptr: a receiver, whose response to irradiance is 1/π
  int index;

  Vec3f eval(Vec3f to_light) const {
    if (bsdf != nullptr) return bsdf->eval(to_viewer, to_light);
    const float value = std::max(0.0F, dot(normal, to_light)) * kInvPi;
    return {value, value, value};
  }
  float pdf(Vec3f to_light) const {
    return bsdf != nullptr ? bsdf->pdf(to_viewer, to_light) : std::max(0.0F, dot(normal, to_light)) * kInvPi;
  }
};

PathTracer::PathTracer(const RayTracer& tracer, const Lights& lights, int bounces, bool scene_emission)
    : tracer_(tracer),
      lights_(lights),
      emitters_(scene_emission ? tracer.scene() : scene_without_emission()),
      bounces_(bounces < 0 ? std::numeric_limits<int>::max() : bounces) {}

float PathTracer::visibility(Vec3f origin, Vec3f to_light, float distance, Sampler& sampler) const {
  // A little short of the light, so that an emissive triangle does not hide itself.
  const float far = distance == kInfinity ? kInfinity : distance * (1 - 1e-4F);
  return tracer_.occluded({origin, to_light, 0, far, sampler.next_bits()}) ? 0.0F : 1.0F;
}

void PathTracer::add_punctual(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  const Vec3f origin = offset_point(v.position, v.normal);
  const auto contribution = [&](std::size_t i, PunctualSample& s) {
    s = sample_punctual(lights_[i], v.position);
    return throughput * v.eval(s.to_light) * s.irradiance;
  };
  PunctualSample s;
  if (v.index == 0) {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      const Vec3f value = contribution(i, s);
      if (max_component(value) > 0) light.add(0, i, visibility(origin, s.to_light, s.distance, sampler) * value);
    }
    return;
  }
  // Further along one light is enough: chosen by what it would bring, if nothing stood between.
  const float pick = sampler.next_1d();
  float total = 0;
  for (std::size_t i = 0; i < lights_.size(); ++i) total += max_component(contribution(i, s));
  float left = pick * total;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const Vec3f value = contribution(i, s);
    const float weight = max_component(value);
    left -= weight;
    if (!(weight > 0) || (left > 0 && i + 1 < lights_.size())) continue;
    light.add(v.index, i, (visibility(origin, s.to_light, s.distance, sampler) * total / weight) * value);
    return;
  }
}

void PathTracer::add_emissive(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  const float pick = sampler.next_1d();
  const EmissiveTriangles::Sample s = emitters_.sample(v.position, pick, sampler.next_2d());
  if (!(s.pdf > 0)) return;
  const Vec3f value = throughput * v.eval(s.to_light) * s.radiance / s.pdf;
  if (!(max_component(value) > 0)) return;
  const float weight = balance_heuristic(s.pdf, v.pdf(s.to_light));
  const Vec3f origin = offset_point(v.position, v.normal);
  light.add(v.index, emission_source(), (weight * visibility(origin, s.to_light, s.distance, sampler)) * value);
}

void PathTracer::trace(Vec3f origin, Vec3f direction, float pdf, int index, Vec3f throughput, Sampler& sampler,
                       PathLight& light) const {
  for (;; ++index) {
    const Ray ray{origin, direction, 0, kInfinity, sampler.next_bits()};
    const auto hit = tracer_.intersect(ray);
    if (!hit) return;
    const SurfacePoint point = make_surface_point(tracer_.scene(), ray, *hit);
    if (!emitters_.empty() && max_component(point.emission) > 0) {
      const float weight = balance_heuristic(pdf, emitters_.pdf(*hit, origin, point.position));
      light.add(index - 1, emission_source(), weight * throughput * point.emission);
    }
    if (index > bounces_) return;
    const Bsdf bsdf(point);
    const Vertex vertex{point.position, point.geometric_normal, -direction, &bsdf, index};
    if (!lights_.empty()) add_punctual(vertex, throughput, sampler, light);
    if (!emitters_.empty()) add_emissive(vertex, throughput, sampler, light);
    if (index == bounces_ && emitters_.empty()) return;
    const Vec2f u = sampler.next_2d();
    const auto next = bsdf.sample(-direction, u, sampler.next_1d());
    if (!next) return;
    throughput *= next->weight;
    if (index + 1 >= kRouletteVertex) {
      const float survival = std::min(kMostSurvival, max_component(throughput));
      if (!(sampler.next_1d() < survival)) return;
      throughput *= 1 / survival;
    }
    origin = offset_point(point.position, point.geometric_normal);
    direction = next->direction;
    pdf = next->pdf;
  }
}

void PathTracer::add_scattered(const SurfacePoint& point, Vec3f to_viewer, int index, Vec3f throughput,
                               Sampler& sampler, PathLight& light) const {
  const Bsdf bsdf(point);
  const Vertex vertex{point.position, point.geometric_normal, to_viewer, &bsdf, index};
  if (!lights_.empty()) add_punctual(vertex, throughput, sampler, light);
  if (!emitters_.empty()) add_emissive(vertex, throughput, sampler, light);
  if (index == bounces_ && emitters_.empty()) return;
  const Vec2f u = sampler.next_2d();
  const auto next = bsdf.sample(to_viewer, u, sampler.next_1d());
  if (!next) return;
  trace(offset_point(point.position, point.geometric_normal), next->direction, next->pdf, index + 1,
        throughput * next->weight, sampler, light);
}

void PathTracer::add_punctual_illumination(Vec3f position, Vec3f normal, Sampler& sampler, PathLight& light) const {
  if (!lights_.empty()) add_punctual({position, normal, normal, nullptr, 0}, {1, 1, 1}, sampler, light);
}

void PathTracer::add_illumination(Vec3f position, Vec3f normal, bool with_punctual, Sampler& sampler,
                                  PathLight& light) const {
  const Vertex vertex{position, normal, normal, nullptr, 0};
  if (with_punctual) add_punctual_illumination(position, normal, sampler, light);
  if (!emitters_.empty()) add_emissive(vertex, {1, 1, 1}, sampler, light);
  if (bounces_ == 0 && emitters_.empty()) return;
  const Vec3f local = sample_cosine_hemisphere(sampler.next_2d());
  if (!(local.z > 0)) return;
  // Illumination is the mean of incident radiance over cosine-weighted directions.
  trace(offset_point(position, normal), normalize(Frame3f(normal).world_from_local(local)), local.z * kInvPi, 1,
        {1, 1, 1}, sampler, light);
}

bool has_blended_surfaces(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return scene.materials[scene.meshes[instance.mesh].material].alpha_mode == AlphaMode::kBlend;
  });
}

}  // namespace chiaro::renderer
