#pragma once
// What a ray hit: position, normals, and the material's values there.

#include "renderer/trace/ray_tracer.h"

namespace chiaro::renderer {

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
  Vec3f emission;  // cd/m², from both sides
  bool lambert = false;
  bool front = true;  // the ray came from the front face
};

SurfacePoint make_surface_point(const Scene& scene, const Ray& ray, const Hit& hit);

// Alpha of a mesh at barycentric u, v of a triangle: factor × texture × vertex colour.
float surface_alpha(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);

// Emission of a mesh at barycentric u, v of a triangle, cd/m².
Vec3f surface_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v);

}  // namespace chiaro::renderer
