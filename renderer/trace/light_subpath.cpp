// The part of the path tracer that starts at the lights.

#include "renderer/trace/path_vertex.h"

namespace chiaro::renderer {

PathTracer::Path PathTracer::start_path(Sampler& sampler, PathLight& light) const {
  return {sampler, light,
          emission_.empty() || bounces_ == 0 ? std::vector<LightVertex>() : trace_light_subpath(sampler)};
}

std::vector<PathTracer::LightVertex> PathTracer::trace_light_subpath(Sampler& sampler) const {
  const float pick = sampler.next_1d();
  const PunctualEmission::Sample from = emission_.sample(pick, sampler.next_2d());
  Ray ray{from.origin, from.direction, 0, subpath_reach_, sampler.next_bits()};
  Media media = light_media_.empty() ? Media() : light_media_[from.light];
  Vec3f through{1, 1, 1};
  float distance = 0;
  std::vector<LightVertex> vertices;
  while (vertices.size() < kMostClearSurfaces) {
    const auto hit = tracer_.intersect(ray);
    if (!hit) break;
    distance += hit->distance;
    if (!clear_surfaces_) return {{from, *hit, distance, through}};
    const SurfacePoint point = make_surface_point(tracer_.scene(), ray, *hit);
    through *= media.transmittance(point, hit->distance);
    vertices.push_back({from, *hit, distance, through});
    through *= Bsdf(point).clear(-from.direction);
    if (!(max_component(through) > 0)) break;
    media.cross(point);
    ray.origin = point_behind(point);
    ray.far -= hit->distance;
  }
  return vertices;
}

// A light's ray that ends at y, which is connected with the vertex.
void PathTracer::connect(const Vertex& v, const LightVertex& end, Vec3f throughput, Path& path) const {
  const PunctualEmission::Sample& from = end.from;
  const Vec3f position = from.origin + end.distance * from.direction;
  const float r2 = length_squared(position - v.position);
  if (!(r2 > 0)) return;
  const float distance = std::sqrt(r2);
  const Vec3f to_end = (position - v.position) / distance;
  const Vec3f scattered = throughput * v.eval(to_end);
  if (!(max_component(scattered) > 0)) return;

  const Ray connection{v.position, to_end, 0, kInfinity, 0};
  const SurfacePoint point = make_surface_point(tracer_.scene(), connection, end.hit);
  const Bsdf bsdf(point);
  const Vertex y{point.position, point.geometric_normal, point.rounding, -to_end, &bsdf, v.index + 1};
  // A ray from behind the triangle does not arrive, whatever the smooth surface sees.
  const float cosine_light = y.incident_cosine(-from.direction), cosine_vertex = dot(y.normal, -to_end);
  const Vec3f reflected = y.eval(-from.direction, punctual_source(true)) * from.intensity;
  if (!(max_component(reflected) > 0) || !(cosine_light > 0) || !(cosine_vertex > 0)) return;

  // Densities of y, per m², by this ray and by scattering at v followed by picking the same light.
  const float d2 = end.distance * end.distance;
  const float subpath_pdf = emission_.pdf(from.light, from.direction) * cosine_light / d2;
  const float scatter_pdf =
      v.pdf(to_end) * cosine_vertex / r2 * selection_.probability(from.light, y.position, y.pick_normal());
  const float weight = balance_heuristic(subpath_pdf, scatter_pdf);
  const Vec3f value = (weight * cosine_vertex / (r2 * d2 * subpath_pdf)) * scattered * reflected;
  if (!(max_component(value) > 0) || !is_finite(value)) return;
  Ray between = ray_between(v.ray_origin(to_end), y.ray_end(distance), path.sampler.next_bits());
  between.clear = ClearSurfaces::kPassThin;
  path.light.add(v.index + 1, from.light, end.through * light_along(between, v.media_towards(to_end)) * value);
}

}  // namespace chiaro::renderer
