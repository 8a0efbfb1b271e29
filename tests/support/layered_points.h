#pragma once
// Surface points of all kinds of material, for tests of scattering.

#include <string>
#include <vector>

#include "renderer/core/sampler.h"
#include "renderer/trace/bsdf.h"
#include "renderer/trace/surface_point.h"

namespace chiaro::test {

// In the plane z = 0, seen from above.
inline renderer::SurfacePoint flat_point(renderer::Vec3f color, float metallic, float roughness) {
  renderer::SurfacePoint point;
  point.geometric_normal = point.smooth_normal = point.shading_normal = {0, 0, 1};
  point.base_color = color;
  point.metallic = metallic;
  point.roughness = roughness;
  return point;
}

// The same with layers that change nothing yet.
inline renderer::SurfacePoint layered_point(renderer::Vec3f color, float metallic, float roughness) {
  renderer::SurfacePoint point = flat_point(color, metallic, roughness);
  point.layers.emplace();
  point.layers->clearcoat_normal = {0, 0, 1};
  return point;
}

// What a point sends back of a cosine-weighted sky, by so many sampled directions: red.
inline double mean_reflected(const renderer::SurfacePoint& point, int count) {
  const renderer::Bsdf bsdf(point);
  double mean = 0;
  for (int i = 0; i < count; ++i) {
    renderer::Sampler sampler(3, 0, std::uint32_t(i));
    const renderer::Vec3f viewer = renderer::sample_cosine_hemisphere(sampler.next_2d());
    const renderer::Vec2f u = sampler.next_2d();
    const auto s = bsdf.sample(viewer, u, sampler.next_1d());
    if (s && s->direction.z > 0) mean += double(s->weight.x) / count;
  }
  return mean;
}

struct NamedPoint {
  std::string name;
  renderer::SurfacePoint point;
};

// Every lobe at several roughnesses.
inline std::vector<NamedPoint> layered_points(renderer::Vec3f color) {
  std::vector<NamedPoint> all;
  for (const float roughness : {0.05F, 0.25F, 0.5F, 1.0F}) {
    const auto add = [&](const char* name, float metallic, const auto& change) {
      renderer::SurfacePoint point = layered_point(color, metallic, roughness);
      change(point);
      all.push_back({std::string(name) + " " + std::to_string(roughness), point});
    };
    add("specular", 0, [](auto& p) { p.layers->specular = 0.5F, p.layers->specular_color = {1, 0.5F, 0.2F}; });
    add("ior 2.4", 0, [](auto& p) { p.layers->ior = 2.4F; });
    add("ior 0", 0, [](auto& p) { p.layers->ior = 0; });
    add("sheet", 0, [](auto& p) { p.layers->transmission = 1; });
    add("half a sheet", 0.3F, [](auto& p) { p.layers->transmission = 0.5F; });
    const auto solid = [](auto& p) { p.layers->transmission = 1, p.layers->solid = true; };
    add("into a solid", 0, solid);
    add("out of a solid", 0, [&](auto& p) { solid(p), p.front = false; });
    add("clearcoat on metal", 1, [](auto& p) { p.layers->clearcoat = 1, p.layers->clearcoat_roughness = p.roughness; });
    add("leaning clearcoat", 0, [](auto& p) {
      p.layers->clearcoat = 0.7F, p.layers->clearcoat_roughness = p.roughness;
      p.layers->clearcoat_normal = normalize(renderer::Vec3f{0.3F, 0.1F, 1});
    });
    add("sheen", 0, [](auto& p) { p.layers->sheen_color = {1, 0.6F, 0.3F}, p.layers->sheen_roughness = p.roughness; });
    add("all", 0.2F, [](auto& p) {
      p.layers->clearcoat = 1, p.layers->clearcoat_roughness = 0.2F, p.layers->sheen_color = {0.5F, 0.5F, 0.5F};
      p.layers->sheen_roughness = 0.4F, p.layers->transmission = 0.5F;
    });
  }
  return all;
}

}  // namespace chiaro::test
