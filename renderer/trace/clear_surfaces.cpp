#include "renderer/trace/clear_surfaces.h"

#include <algorithm>

#include "renderer/trace/bsdf.h"

namespace chiaro::renderer {
namespace {

float absorbed(float absorption, float distance) { return absorption > 0 ? std::exp(-absorption * distance) : 1; }

Vec3f absorbed(Vec3f absorption, float distance) {
  return {absorbed(absorption.x, distance), absorbed(absorption.y, distance), absorbed(absorption.z, distance)};
}

}  // namespace

void Media::cross(const SurfacePoint& surface) {
  if (!surface.layers || !surface.layers->solid) return;
  if (surface.front) {
    if (count_ < kMost) inside_[count_++] = {surface.material, surface.layers->absorption};
    return;
  }
  for (int i = count_ - 1; i >= 0; --i) {
    if (inside_[i].material != surface.material) continue;
    std::copy(inside_.begin() + i + 1, inside_.begin() + count_, inside_.begin() + i);
    --count_;
    return;
  }
}

Vec3f Media::transmittance(const SurfacePoint& surface, float distance) const {
  const bool behind_back = surface.layers && surface.layers->solid && !surface.front;
  return behind_back ? absorbed(surface.layers->absorption, distance) : transmittance(distance);
}

Vec3f Media::transmittance(float distance) const {
  return count_ > 0 ? absorbed(inside_[count_ - 1].absorption, distance) : Vec3f{1, 1, 1};
}

Vec3f clear_transmittance(const RayTracer& tracer, const Ray& ray, const Media& media) {
  const float length_of_direction = length(ray.direction);
  Media inside = media;
  Ray rest = ray;
  rest.clear = ClearSurfaces::kStop;
  Vec3f through{1, 1, 1};
  for (int surfaces = 0; surfaces < kMostClearSurfaces; ++surfaces) {
    const auto hit = tracer.intersect(rest);
    const float distance = (hit ? hit->distance : rest.far) * length_of_direction;
    if (!hit) return distance < kInfinity ? through * inside.transmittance(distance) : through;
    const SurfacePoint point = make_surface_point(tracer.scene(), rest, *hit);
    through *= inside.transmittance(point, distance) * Bsdf(point).clear(-ray.direction / length_of_direction);
    if (!(max_component(through) > 0)) return {};
    inside.cross(point);
    rest.origin = point_behind(point);
    rest.far -= hit->distance;
    if (!(rest.far > 0)) return through;
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
