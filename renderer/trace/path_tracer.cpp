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
      emission_(lights),
      subpath_reach_(kSubpathReach * tracer.bounds().diagonal()),
      emitters_(scene_emission ? tracer.scene() : scene_without_emission()),
      bounces_(bounces < 0 ? std::numeric_limits<int>::max() : bounces) {}

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

// One light is picked in proportion to the irradiance it would give if nothing stood between.
float PathTracer::pick_weight(const Vertex& v, std::size_t light) const {
  const PunctualSample s = sample_punctual(lights_[light], v.position);
  return std::max(0.0F, dot(v.pick_normal(), s.to_light)) * max_component(s.irradiance);
}

std::size_t PathTracer::pick_light(const Vertex& v, float pick, float& probability) const {
  std::size_t chosen = lights_.size();
  float total = 0, chosen_weight = 0;
  // A reservoir of one: light i replaces the choice with probability weight / total so far, and what is left of `pick`
  // is stretched to a fresh random number.
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const float weight = pick_weight(v, i);
    if (!(weight > 0)) continue;
    total += weight;
    const float replace = weight / total;
    if (pick < replace) {
      chosen = i;
      chosen_weight = weight;
      pick /= replace;
    } else {
      pick = (pick - replace) / (1 - replace);
    }
  }
  probability = chosen_weight / total;
  return chosen;
}

float PathTracer::pick_probability(const Vertex& v, std::size_t light) const {
  float total = 0;
  for (std::size_t i = 0; i < lights_.size(); ++i) total += pick_weight(v, i);
  return total > 0 ? pick_weight(v, light) / total : 0;
}

// Beyond vertex 0, where one light is enough. Weighted against a ray from that light having ended here.
void PathTracer::add_one_punctual(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  float probability = 0;
  const std::size_t i = pick_light(v, sampler.next_1d(), probability);
  if (i == lights_.size()) return;
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
  const float scatter_pdf = v.pdf(to_end) * cosine_vertex / r2 * pick_probability(y, from.light);
  const float weight = balance_heuristic(subpath_pdf, scatter_pdf);
  const Vec3f value = (weight * cosine_vertex / (r2 * d2 * subpath_pdf)) * scattered * reflected;
  if (!(max_component(value) > 0) || !is_finite(value)) return;
  if (tracer_.occluded_between(v.ray_origin(), y.ray_end(distance), sampler.next_bits())) return;
  light.add(v.index + 1, from.light, value);
}

void PathTracer::add_emissive(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  const float pick = sampler.next_1d();
  const EmissiveTriangles::Sample s = emitters_.sample(v.position, pick, sampler.next_2d());
  if (!(s.pdf > 0)) return;
  const Vec3f value = throughput * v.eval(s.to_light) * s.radiance / s.pdf;
  if (!(max_component(value) > 0)) return;
  const float weight = balance_heuristic(s.pdf, v.pdf(s.to_light));
  light.add(v.index, emission_source(), (weight * visibility(v, s.to_light, s.distance, sampler)) * value);
}

// The light of one vertex, but for what scattered rays bring.
void PathTracer::add_lights(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  if (!lights_.empty()) {
    if (v.index == 0) {
      add_all_punctual(v, throughput, sampler, light);
    } else {
      add_one_punctual(v, throughput, sampler, light);
    }
  }
  add_indirect_samples(v, throughput, sampler, light);
}

void PathTracer::add_indirect_samples(const Vertex& v, Vec3f throughput, Sampler& sampler, PathLight& light) const {
  if (!emission_.empty() && v.index < bounces_) add_light_subpath(v, throughput, sampler, light);
  if (!emitters_.empty()) add_emissive(v, throughput, sampler, light);
}

void PathTracer::trace(Vec3f origin, Vec3f direction, float pdf, int index, Vec3f throughput, Sampler& sampler,
                       PathLight& light) const {
  for (;; ++index) {
    const Ray ray{origin, direction, 0, kInfinity, sampler.next_bits(), 0, scattered_cone(pdf)};
    const auto hit = tracer_.intersect(ray);
    if (!hit) return;
    const SurfacePoint point = make_surface_point(tracer_.scene(), ray, *hit);
    if (!emitters_.empty() && max_component(point.emission) > 0) {
      const float weight = balance_heuristic(pdf, emitters_.pdf(*hit, origin, point.position));
      light.add(index - 1, emission_source(), weight * throughput * point.emission);
    }
    if (index > bounces_) return;
    const Bsdf bsdf(point);
    const float cosine = dot(point.geometric_normal, -direction);
    const float area_pdf = pdf * cosine / (hit->distance * hit->distance);
    const Vertex vertex{point.position, point.geometric_normal, point.rounding, -direction, &bsdf, index, area_pdf,
                        point.lift,     point.geometric_normal};
    add_lights(vertex, throughput, sampler, light);
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
    origin = vertex.ray_origin();
    direction = next->direction;
    pdf = next->pdf;
  }
}

void PathTracer::add_scattered(const SurfacePoint& point, Vec3f to_viewer, int index, Vec3f throughput,
                               Sampler& sampler, PathLight& light) const {
  const Bsdf bsdf(point);
  const Vertex vertex{point.position, point.geometric_normal, point.rounding, to_viewer, &bsdf, index, 0,
                      point.lift,     point.geometric_normal};
  add_lights(vertex, throughput, sampler, light);
  if (index == bounces_ && emitters_.empty()) return;
  const Vec2f u = sampler.next_2d();
  const auto next = bsdf.sample(to_viewer, u, sampler.next_1d());
  if (!next) return;
  trace(vertex.ray_origin(), next->direction, next->pdf, index + 1, throughput * next->weight, sampler, light);
}

void PathTracer::add_punctual_illumination(Vec3f position, Vec3f normal, Sampler& sampler, PathLight& light) const {
  add_all_punctual({position, normal, 0, normal, nullptr, 0}, {1, 1, 1}, sampler, light);
}

void PathTracer::add_illumination(Vec3f position, Vec3f normal, bool with_punctual, Sampler& sampler,
                                  PathLight& light) const {
  if (with_punctual) add_punctual_illumination(position, normal, sampler, light);
  add_indirect_illumination({position, normal, 0, normal, nullptr, 0}, sampler, light);
}

void PathTracer::add_illumination(const SurfacePoint& point, Sampler& sampler, PathLight& light) const {
  // Rays start along the shading normal, which leans: as far off the surface as they would along the geometric one.
  constexpr float kLeastCosine = 0.1F;
  const Vec3f normal = point.shading_normal;
  const float rounding = point.rounding / std::max(kLeastCosine, dot(normal, point.geometric_normal));
  const Vertex vertex{point.position, normal, rounding, normal, nullptr, 0, 0, point.lift, point.geometric_normal};
  add_all_punctual(vertex, {1, 1, 1}, sampler, light);
  add_indirect_illumination(vertex, sampler, light);
}

void PathTracer::add_indirect_illumination(const Vertex& vertex, Sampler& sampler, PathLight& light) const {
  add_indirect_samples(vertex, {1, 1, 1}, sampler, light);
  if (bounces_ == 0 && emitters_.empty()) return;
  const Vec3f local = sample_cosine_hemisphere(sampler.next_2d());
  if (!(local.z > 0)) return;
  // Illumination is the mean of incident radiance over cosine-weighted directions.
  trace(vertex.ray_origin(), normalize(Frame3f(vertex.normal).world_from_local(local)), local.z * kInvPi, 1, {1, 1, 1},
        sampler, light);
}

bool has_blended_surfaces(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return scene.materials[scene.meshes[instance.mesh].material].alpha_mode == AlphaMode::kBlend;
  });
}

}  // namespace chiaro::renderer
