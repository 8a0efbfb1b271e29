#pragma once
// What a ray hit: position, normals, and the material's values there.

#include <optional>

#include "renderer/trace/ray_tracer.h"

namespace chiaro::renderer {

// MaterialLayers at a point.
struct SurfaceLayers {
  float ior = 1.5F;
  float specular = 1;
  Vec3f specular_color{1, 1, 1};
  float transmission = 0;
  bool solid = false;
  Vec3f absorption;  // 1 / metres, behind the surface
  float clearcoat = 0, clearcoat_roughness = 0;
  Vec3f clearcoat_normal;  // unit, never facing away from the ray
  Vec3f sheen_color;
  float sheen_roughness = 0;
};

struct SurfacePoint {
  Vec3f position;
  float rounding = 0;      // metres; how far off the surface floats may have put it: for offset_point
  Vec3f geometric_normal;  // unit, on the side that the ray came from
  Vec3f smooth_normal;     // unit, the vertices' interpolated, on that side
  Vec3f shading_normal;    // unit, with the normal map, bent where it would reflect the ray into the surface
  // Metres to the surface that the vertices' normals stand for, where it is rounder than its triangles: for light from
  // below the triangle's horizon and above the surface's own.
  Vec3f lift;
  Vec3f base_color;  // linear
  float metallic = 0, roughness = 1;
  Vec3f emission;  // cd/m², from both sides; of an unlit surface, what a camera sees
  bool lambert = false;
  bool geometric_horizon = false;  // as Material's
  bool front = true;               // the ray came from the front face
  bool unlit = false;
  int material = 0;                     // index into Scene::materials
  std::optional<SurfaceLayers> layers;  // absent: Lambert or plain metallic-roughness
};

// Where a ray goes on that passes straight through the surface.
inline Vec3f point_behind(const SurfacePoint& point) {
  return offset_point(point.position, -point.geometric_normal, point.rounding);
}

SurfacePoint make_surface_point(const Scene& scene, const Ray& ray, const Hit& hit);

// Alpha of a mesh at barycentric u, v of a triangle: factor × texture × vertex colour.
float surface_alpha(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);
// The part of all rays that its material's alpha mode holds there; the others pass.
float surface_coverage(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);

// A transmission of at most this roughness counts as clear: thin sheets let light straight through, and the shadow rays
// of punctual lights pass both sheets and solids.
inline bool is_clear(float roughness) { return roughness <= 0.1F; }

// Whether a mesh transmits clearly at barycentric u, v of a triangle.
bool surface_is_clear(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);

// Luminance of what a clear surface lets through there, about; `cosine`: of the ray with the triangle's normal.
float clear_luminance(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, Vec2f uv, float cosine);

// Emission of a mesh at barycentric u, v of a triangle, cd/m², below a clearcoat.
Vec3f surface_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);

}  // namespace chiaro::renderer
