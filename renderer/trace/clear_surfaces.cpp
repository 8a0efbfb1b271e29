#include "renderer/trace/clear_surfaces.h"

#include <algorithm>
#include <vector>

#include "renderer/trace/bsdf.h"

namespace chiaro::renderer {
namespace {

float absorbed(float absorption, float distance) { return absorption > 0 ? std::exp(-absorption * distance) : 1; }

Vec3f absorbed(Vec3f absorption, float distance) {
  return {absorbed(absorption.x, distance), absorbed(absorption.y, distance), absorbed(absorption.z, distance)};
}

bool bounds_solid(const SurfacePoint& surface) { return surface.layers && surface.layers->solid; }

// A solid that rays from a point meet the boundary of.
struct SolidAround {
  int material = 0;
  Vec3f absorption{};
  int leaving = 0, entering = 0;  // rays, where they meet it first
  float distance = kInfinity;     // of the nearest place where one leaves it
};

SolidAround& find_or_add(const SurfacePoint& boundary, std::vector<SolidAround>& solids) {
  const auto is_its = [&](const SolidAround& solid) { return solid.material == boundary.material; };
  const auto found = std::find_if(solids.begin(), solids.end(), is_its);
  if (found != solids.end()) return *found;
  return solids.emplace_back(SolidAround{.material = boundary.material, .absorption = boundary.layers->absorption});
}

void ask_ray(const RayTracer& tracer, Ray ray, std::vector<SolidAround>& solids) {
  std::vector<int> met;  // materials
  float distance = 0;
  for (int surfaces = 0; surfaces < kMostClearSurfaces; ++surfaces) {
    const auto hit = tracer.intersect(ray);
    if (!hit) return;
    const SurfacePoint point = make_surface_point(tracer.scene(), ray, *hit);
    distance += hit->distance;
    ray.origin = point_behind(point);
    if (!bounds_solid(point) || std::find(met.begin(), met.end(), point.material) != met.end()) continue;
    met.push_back(point.material);
    SolidAround& solid = find_or_add(point, solids);
    ++(point.front ? solid.entering : solid.leaving);
    if (!point.front) solid.distance = std::min(solid.distance, distance);
  }
}

}  // namespace

Media Media::at(const RayTracer& tracer, Vec3f position) {
  // None along an axis, where surfaces often lie.
  constexpr Vec3f kDirections[] = {{0.88F, 0.31F, 0.36F},   {-0.83F, 0.41F, -0.38F}, {0.29F, 0.90F, -0.33F},
                                   {-0.35F, -0.87F, 0.34F}, {0.42F, -0.27F, -0.87F}, {-0.33F, 0.24F, 0.91F}};
  std::vector<SolidAround> solids;
  for (const Vec3f& direction : kDirections) ask_ray(tracer, {position, normalize(direction), 0, kInfinity, 0}, solids);
  std::erase_if(solids, [](const SolidAround& solid) { return solid.leaving <= solid.entering; });
  // The innermost, whose boundary is the nearest, comes last.
  std::stable_sort(solids.begin(), solids.end(), [](const auto& a, const auto& b) { return a.distance > b.distance; });
  Media media;
  for (const SolidAround& solid : solids) media.enter({solid.material, solid.absorption});
  return media;
}

void Media::enter(const Solid& solid) {
  if (count_ < kMost) inside_[count_++] = solid;
}

void Media::cross(const SurfacePoint& surface) {
  if (!bounds_solid(surface)) return;
  if (surface.front) return enter({surface.material, surface.layers->absorption});
  for (int i = count_ - 1; i >= 0; --i) {
    if (inside_[i].material != surface.material) continue;
    std::copy(inside_.begin() + i + 1, inside_.begin() + count_, inside_.begin() + i);
    --count_;
    return;
  }
}

Vec3f Media::transmittance(const SurfacePoint& surface, float distance) const {
  const bool behind_back = bounds_solid(surface) && !surface.front;
  return behind_back ? absorbed(surface.layers->absorption, distance) : transmittance(distance);
}

Vec3f Media::transmittance(float distance) const {
  return count_ > 0 ? absorbed(inside_[count_ - 1].absorption, distance) : Vec3f{1, 1, 1};
}

Vec3f clear_transmittance(const RayTracer& tracer, const Ray& ray, const Media& media) {
  const Vec3f to_viewer = -normalize(ray.direction), end = ray.origin + ray.far * ray.direction;
  Media inside = media;
  Ray rest = ray;
  rest.clear = ClearSurfaces::kStop;
  Vec3f through{1, 1, 1};
  for (int surfaces = 0; surfaces < kMostClearSurfaces; ++surfaces) {
    const auto hit = tracer.intersect(rest);
    const float distance = (hit ? hit->distance : rest.far) * length(rest.direction);
    if (!hit) return through * inside.transmittance(distance);
    const SurfacePoint point = make_surface_point(tracer.scene(), rest, *hit);
    through *= inside.transmittance(point, distance) * Bsdf(point).clear(to_viewer);
    if (!(max_component(through) > 0)) return {};
    inside.cross(point);
    rest.origin = point_behind(point);
    if (ray.far == kInfinity) continue;
    // To where it went, from beside its line.
    rest.direction = end - rest.origin, rest.far = 1;
    if (!(dot(rest.direction, ray.direction) > 0)) return through;
  }
  return {};
}

bool has_clear_surfaces(const Scene& scene) {
  return any_drawn_material(scene, [](const Material& m) { return m.layers && m.layers->transmission > 0; });
}

bool has_solids(const Scene& scene) {
  return any_drawn_material(scene, [](const Material& m) { return m.layers && m.layers->solid; });
}

}  // namespace chiaro::renderer
