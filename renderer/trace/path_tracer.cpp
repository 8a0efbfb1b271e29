#include "renderer/trace/path_tracer.h"

#include <limits>

namespace chiaro::renderer {
namespace {

// From this vertex on a path survives with the probability of its throughput, at most kMostSurvival so that it ends
// among surfaces of albedo 1 too.
constexpr int kRouletteVertex = 3;
constexpr float kMostSurvival = 0.95F;

// Light subpaths are as long as this part of the scene's diagonal at most. Their business is the bright spot close to a
// light; farther away scattered rays find as much, for less.
constexpr float kSubpathReach = 0.1F;

// Lights that vertex 0 asks where there are many.
constexpr int kAsked = 4;

// 0 where both are zero or infinite: a point of no measure.
float balance_heuristic(float pdf, float other) {
  const float weight = pdf / (pdf + other);
  return weight >= 0 ? weight : 0;
}

// By how much the cone grows that a scattered ray stands for when textures are looked up: by the width of the
// directions that share its density, as if some hundred rays shared them.
float scattered_cone(float pdf) {
  constexpr float kScattered = 0.0625F;
  return pdf > 0 ? kScattered / std::sqrt(pdf) : 0;
}

// Emission from no triangle at all, where the scene's own is not wanted.
const Scene& scene_without_emission() {
  static const Scene empty;
  return empty;
}

// Finer than floats, so that none of very many lights is out of reach.
double next_fine(Sampler& sampler) {
  const double coarse = double(sampler.next_1d());
  return coarse + double(sampler.next_bits()) * 0x1p-56;
}

}  // namespace

// A surface that light is gathered at: either a material's, or a white receiver of which illumination is asked.
struct PathTracer::Vertex {
  Vec3f position;
  Vec3f normal;    // geometric; rays start on its side
  float rounding;  // of position, as SurfacePoint's
  Vec3f to_viewer;
  const Bsdf* bsdf;  // nullptr: a receiver, whose response to irradiance is 1/π
  int index;
  float area_pdf = 0;  // with which scattering at the vertex before found this one, per m²

  // As SurfacePoint's; no lift: rays start at the position whatever their direction.
  Vec3f lift{}, triangle_normal{};

  // Light from below the triangle's horizon that the smooth surface sees: shadow rays start up there.
  bool sees_past_triangle(Vec3f to_light) const {
    return max_component(abs(lift)) > 0 && dot(triangle_normal, to_light) <= 0;
  }

  Vec3f eval(Vec3f to_light) const {
    if (bsdf != nullptr) return bsdf->eval(to_viewer, to_light);
    const float value = std::max(0.0F, dot(normal, to_light)) * kInvPi;
    return {value, value, value};
  }
  float pdf(Vec3f to_light) const {
    return bsdf != nullptr ? bsdf->pdf(to_viewer, to_light) : std::max(0.0F, dot(normal, to_light)) * kInvPi;
  }
  Vec3f pick_normal() const { return bsdf != nullptr ? bsdf->normal() : normal; }
  Vec3f ray_origin() const { return offset_point(position, normal, rounding); }
  // Where a ray from so many metres away ends before it meets the vertex's own surface.
  Vec3f ray_end(float distance) const {
    return offset_point(position, normal, std::max(rounding, surface_rounding(distance, 0)));
  }
};

PathTracer::PathTracer(const RayTracer& tracer, const Lights& lights, int bounces, bool scene_emission)
    : tracer_(tracer),
      lights_(lights),
      selection_(lights),
      emission_(lights),
      subpath_reach_(kSubpathReach * tracer.bounds().diagonal()),
      emitters_(scene_emission ? tracer.scene() : scene_without_emission()),
      bounces_(bounces < 0 ? std::numeric_limits<int>::max() : bounces) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (const auto* light = std::get_if<EnvironmentLight>(&lights[i]); light != nullptr && light->intensity > 0) {
      environments_.push_back({i, EnvironmentSampling(*light)});
    }
  }
}

float PathTracer::visibility(const Vertex& v, Vec3f to_light, float distance, Sampler& sampler) const {
  // A little short of the light, so that an emissive triangle does not hide itself.
  constexpr float kShort = 1e-4F;
  const float far = distance == kInfinity ? kInfinity : distance * (1 - kShort);
  const std::uint32_t alpha_seed = sampler.next_bits();
  const Vec3f origin = v.ray_origin();
  if (!v.sees_past_triangle(to_light)) return tracer_.occluded({origin, to_light, 0, far, alpha_seed}) ? 0.0F : 1.0F;
  const Vec3f lifted = offset_point(v.position + v.lift, v.normal, v.rounding);
  if (tracer_.occluded({origin, lifted - origin, 0, 1, alpha_seed})) return 0;
  const Vec3f along = far == kInfinity ? to_light : v.position + distance * to_light - lifted;
  return tracer_.occluded({lifted, along, 0, far == kInfinity ? kInfinity : 1 - kShort, alpha_seed}) ? 0.0F : 1.0F;
}

void PathTracer::add_all_punctual(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const PunctualSample s = sample_punctual(lights_[i], v.position);
    const Vec3f value = throughput * v.eval(s.to_light) * s.irradiance;
    if (max_component(value) > 0) light.add(v.index, i, visibility(v, s.to_light, s.distance, sampler) * value);
  }
}

void PathTracer::add_chosen(const Vertex& v, LightSelection::Pick chosen, Vec3f throughput, Sampler& sampler,
                            PathLight& light) const {
  const PunctualSample s = sample_punctual(lights_[chosen.light], v.position);
  const Vec3f value = throughput * v.eval(s.to_light) * s.irradiance / chosen.probability;
  if (!(max_component(value) > 0) || !is_finite(value)) return;
  light.add(v.index, chosen.light, visibility(v, s.to_light, s.distance, sampler) * value);
}

void PathTracer::add_some_punctual(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  const double u = next_fine(sampler);
  if (!selection_.weighs_all()) {
    for (int k = 0; k < kAsked; ++k) {
      const LightSelection::Pick pick = selection_.pick(v.position, v.pick_normal(), (k + u) / kAsked);
      if (pick.probability > 0) add_chosen(v, {pick.light, kAsked * pick.probability}, throughput, sampler, light);
    }
    return;
  }
  LightSelection::Weights weights;
  const Bsdf::Sketch surface = v.bsdf != nullptr ? v.bsdf->sketch() : Bsdf::Sketch{};
  const double total = selection_.weigh(v.position, v.pick_normal(), v.to_viewer, surface, weights);
  double sum = 0;
  for (int i = 0, asked = 0; i < int(selection_.order().size()) && asked < kAsked; ++i) {
    const double weight = double(weights[std::size_t(i)]);
    sum += weight;
    int times = 0;
    for (; asked < kAsked && (asked + u) * total < sum * kAsked; ++asked) ++times;
    if (times == 0) continue;
    const float expected_times = float(kAsked * weight / total);
    add_chosen(v, {selection_.order()[std::size_t(i)], expected_times / float(times)}, throughput, sampler, light);
  }
}

// Beyond vertex 0, where one light is enough. Weighted against a ray from that light having ended here.
void PathTracer::add_one_punctual(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  const auto [i, probability] = selection_.pick(v.position, v.pick_normal(), next_fine(sampler));
  if (!(probability > 0)) return;
  const PunctualSample s = sample_punctual(lights_[i], v.position);
  const Vec3f value = throughput * v.eval(s.to_light) * s.irradiance / probability;
  if (!is_finite(value)) return;  // closer to the light than floats can tell
  float weight = 1;
  const float cosine = dot(v.normal, s.to_light);
  if (s.distance <= subpath_reach_ && cosine > 0) {
    const float subpath_pdf = emission_.pdf(i, -s.to_light) * cosine / (s.distance * s.distance);
    weight = balance_heuristic(v.area_pdf * probability, subpath_pdf);
  }
  light.add(v.index, i, (weight * visibility(v, s.to_light, s.distance, sampler)) * value);
}

// A ray from a light ends at y, and y is connected with the vertex.
void PathTracer::add_light_subpath(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  const float pick = sampler.next_1d();
  const PunctualEmission::Sample from = emission_.sample(pick, sampler.next_2d());
  const auto hit = tracer_.intersect({from.origin, from.direction, 0, subpath_reach_, sampler.next_bits()});
  if (!hit) return;
  const Vec3f end = from.origin + hit->distance * from.direction;
  const float r2 = length_squared(end - v.position);
  if (!(r2 > 0)) return;
  const float distance = std::sqrt(r2);
  const Vec3f to_end = (end - v.position) / distance;
  const Vec3f scattered = throughput * v.eval(to_end);
  if (!(max_component(scattered) > 0)) return;

  const Ray connection{v.position, to_end, 0, kInfinity, 0};
  const SurfacePoint point = make_surface_point(tracer_.scene(), connection, *hit);
  const Bsdf bsdf(point);
  const Vertex y{point.position, point.geometric_normal, point.rounding, -to_end, &bsdf, v.index + 1};
  // A ray from behind the triangle does not arrive, whatever the smooth surface sees.
  const float cosine_light = -dot(y.normal, from.direction), cosine_vertex = dot(y.normal, -to_end);
  const Vec3f reflected = y.eval(-from.direction) * from.intensity;
  if (!(max_component(reflected) > 0) || !(cosine_light > 0) || !(cosine_vertex > 0)) return;

  // Densities of y, per m², by this ray and by scattering at v followed by picking the same light.
  const float d2 = hit->distance * hit->distance;
  const float subpath_pdf = emission_.pdf(from.light, from.direction) * cosine_light / d2;
  const float scatter_pdf =
      v.pdf(to_end) * cosine_vertex / r2 * selection_.probability(from.light, y.position, y.pick_normal());
  const float weight = balance_heuristic(subpath_pdf, scatter_pdf);
  const Vec3f value = (weight * cosine_vertex / (r2 * d2 * subpath_pdf)) * scattered * reflected;
  if (!(max_component(value) > 0) || !is_finite(value)) return;
  if (tracer_.occluded_between(v.ray_origin(), y.ray_end(distance), sampler.next_bits())) return;
  light.add(v.index + 1, from.light, value);
}

void PathTracer::add_emissive(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  const double pick = next_fine(sampler);
  const EmissiveTriangles::Sample s = emitters_.sample(v.position, v.pick_normal(), pick, sampler.next_2d());
  if (!(s.pdf > 0)) return;
  const Vec3f value = throughput * v.eval(s.to_light) * s.radiance / s.pdf;
  if (!(max_component(value) > 0)) return;
  const float weight = balance_heuristic(s.pdf, v.pdf(s.to_light));
  light.add(v.index, emission_source(), (weight * visibility(v, s.to_light, s.distance, sampler)) * value);
}

void PathTracer::add_environments(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  for (const Environment& environment : environments_) {
    const EnvironmentSampling::Sample s = environment.sampling.sample(sampler.next_2d());
    if (!(s.pdf > 0)) continue;
    const Vec3f value = throughput * v.eval(s.direction) * s.radiance / s.pdf;
    if (!(max_component(value) > 0)) continue;
    const float weight = balance_heuristic(s.pdf, v.pdf(s.direction));
    light.add(v.index, environment.source, (weight * visibility(v, s.direction, kInfinity, sampler)) * value);
  }
}

// What a scattered ray finds that meets nothing.
void PathTracer::add_missed(const ScatteredRay& ray, int index, Vec3f throughput, PathLight& light) const {
  for (const Environment& environment : environments_) {
    const float weight = balance_heuristic(ray.pdf, environment.sampling.pdf(ray.direction));
    light.add(index - 1, environment.source, weight * throughput * environment.sampling.radiance(ray.direction));
  }
}

void PathTracer::add_background(Vec3f direction, PathLight& light) const {
  for (const Environment& environment : environments_) {
    light.add(0, environment.source, environment.sampling.radiance(direction));
  }
}

void PathTracer::add_punctual(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  if (lights_.empty()) return;
  if (v.index > 0) {
    add_one_punctual(v, throughput, sampler, light);
  } else if (selection_.few()) {
    add_all_punctual(v, throughput, sampler, light);
  } else {
    add_some_punctual(v, throughput, sampler, light);
  }
}

// The light of one vertex, but for what scattered rays bring.
void PathTracer::add_lights(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  add_punctual(v, throughput, sampler, light);
  add_indirect_samples(v, throughput, sampler, light);
}

void PathTracer::add_indirect_samples(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  if (!emission_.empty() && v.index < bounces_) add_light_subpath(v, throughput, sampler, light);
  if (!emitters_.empty()) add_emissive(v, throughput, sampler, light);
  add_environments(v, throughput, sampler, light);
}

void PathTracer::trace(ScatteredRay scattered, int index, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  for (;; ++index) {
    const Ray ray{
        scattered.origin, scattered.direction, 0, kInfinity, sampler.next_bits(), 0, scattered_cone(scattered.pdf)};
    const auto hit = tracer_.intersect(ray);
    if (!hit) return add_missed(scattered, index, throughput, light);
    const SurfacePoint point = make_surface_point(tracer_.scene(), ray, *hit);
    if (!emitters_.empty() && max_component(point.emission) > 0) {
      const float light_pdf = emitters_.pdf(*hit, scattered.position, scattered.normal, point.position);
      const float weight = balance_heuristic(scattered.pdf, light_pdf);
      light.add(index - 1, emission_source(), weight * throughput * point.emission);
    }
    if (index > bounces_) return;
    const Bsdf bsdf(point);
    const Vec3f to_viewer = -scattered.direction;
    const float cosine = dot(point.geometric_normal, to_viewer);
    const float area_pdf = scattered.pdf * cosine / (hit->distance * hit->distance);
    const Vertex vertex{point.position, point.geometric_normal, point.rounding, to_viewer, &bsdf, index, area_pdf,
                        point.lift,     point.geometric_normal};
    add_lights(vertex, throughput, sampler, light);
    if (index == bounces_ && !has_emission()) return;
    const Vec2f u = sampler.next_2d();
    const auto next = bsdf.sample(to_viewer, u, sampler.next_1d());
    if (!next) return;
    throughput *= next->weight;
    if (index + 1 >= kRouletteVertex) {
      const float survival = std::min(kMostSurvival, max_component(throughput));
      if (!(sampler.next_1d() < survival)) return;
      throughput *= 1 / survival;
    }
    scattered = {vertex.ray_origin(), next->direction, next->pdf, vertex.position, vertex.pick_normal()};
  }
}

void PathTracer::add_scattered(const SurfacePoint& point, Vec3f to_viewer, int index, Vec3f throughput,
                               Sampler& sampler, PathLight& light) const {
  const Bsdf bsdf(point);
  const Vertex vertex{point.position, point.geometric_normal, point.rounding, to_viewer, &bsdf, index, 0,
                      point.lift,     point.geometric_normal};
  add_lights(vertex, throughput, sampler, light);
  if (index == bounces_ && !has_emission()) return;
  const Vec2f u = sampler.next_2d();
  const auto next = bsdf.sample(to_viewer, u, sampler.next_1d());
  if (!next) return;
  trace({vertex.ray_origin(), next->direction, next->pdf, vertex.position, vertex.pick_normal()}, index + 1,
        throughput * next->weight, sampler, light);
}

void PathTracer::add_punctual_illumination(Vec3f position, Vec3f normal, Sampler& sampler, PathLight& light) const {
  add_all_punctual({position, normal, 0, normal, nullptr, 0}, {1, 1, 1}, sampler, light);
}

void PathTracer::add_illumination(Vec3f position, Vec3f normal, bool with_punctual, Sampler& sampler,
                                  PathLight& light) const {
  const Vertex vertex{position, normal, 0, normal, nullptr, 0};
  if (with_punctual) add_punctual(vertex, {1, 1, 1}, sampler, light);
  add_indirect_illumination(vertex, sampler, light);
}

void PathTracer::add_illumination(const SurfacePoint& point, Sampler& sampler, PathLight& light) const {
  // Rays start along the shading normal, which leans: as far off the surface as they would along the geometric one.
  constexpr float kLeastCosine = 0.1F;
  const Vec3f normal = point.shading_normal;
  const float rounding = point.rounding / std::max(kLeastCosine, dot(normal, point.geometric_normal));
  const Vertex vertex{point.position, normal, rounding, normal, nullptr, 0, 0, point.lift, point.geometric_normal};
  add_punctual(vertex, {1, 1, 1}, sampler, light);
  add_indirect_illumination(vertex, sampler, light);
}

void PathTracer::add_indirect_illumination(const Vertex& vertex, Sampler& sampler, PathLight& light) const {
  add_indirect_samples(vertex, {1, 1, 1}, sampler, light);
  if (bounces_ == 0 && !has_emission()) return;
  const Vec3f local = sample_cosine_hemisphere(sampler.next_2d());
  if (!(local.z > 0)) return;
  const Vec3f direction = normalize(Frame3f(vertex.normal).world_from_local(local));
  // Illumination is the mean of incident radiance over cosine-weighted directions.
  trace({vertex.ray_origin(), direction, local.z * kInvPi, vertex.position, vertex.pick_normal()}, 1, {1, 1, 1},
        sampler, light);
}

bool has_blended_surfaces(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return scene.materials[scene.meshes[instance.mesh].material].alpha_mode == AlphaMode::kBlend;
  });
}

}  // namespace chiaro::renderer
