#include "renderer/trace/surface_point.h"

#include "renderer/trace/fresnel.h"
#include "renderer/trace/texture_lookup.h"
#include "renderer/trace/triangle_extent.h"

namespace chiaro::renderer {
namespace {

// A triangle's corner values blended at barycentric u, v.
template <class T>
T interpolate(const std::vector<T>& values, const Triangle& t, float u, float v) {
  return (1 - u - v) * values[t[0]] + u * values[t[1]] + v * values[t[2]];
}

struct Locus {
  const Scene& scene;
  const Mesh& mesh;
  const Triangle& triangle;
  float u, v;
  float footprint = 0;  // area of the ray's cone here, in areas of the triangle; 0: textures in full

  std::optional<Vec4f> sample(const TextureUse& use, bool srgb) const {
    if (use.texture < 0 || mesh.uv[use.uv_set].empty()) return std::nullopt;
    const Texture& texture = scene.textures[use.texture];
    return look_up(texture, uv_of(use), srgb, mip_level_for(use, texture));
  }

  Vec2f uv_of(const TextureUse& use) const {
    const Vec2f uv = interpolate(mesh.uv[use.uv_set], triangle, u, v);
    return use.transformed ? use.transform(uv) : uv;
  }

  int mip_level_for(const TextureUse& use, const Texture& texture) const {
    if (!(footprint > 0) || !has_mips(texture)) return 0;
    const auto& uv = mesh.uv[use.uv_set];
    const Vec2f a = uv[triangle[0]], b = uv[triangle[1]], c = uv[triangle[2]];
    const float area = 0.5F * std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
    const float scaled = use.transformed ? area * use.transform.area_scale() : area;
    return mip_level_of(footprint * scaled * float(texture.width) * float(texture.height));
  }
};

Locus locus_at(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  return {scene, mesh, mesh.triangles[triangle], u, v, 0};
}

Vec3f base_color(const Locus& at, const Material& material) {
  Vec3f color = material.base_color;
  if (material.constant_base_color) return color;
  if (const auto texel = at.sample(material.base_color_texture, true)) color *= {texel->x, texel->y, texel->z};
  if (!at.mesh.colors.empty()) {
    const Vec4f vertex = interpolate(at.mesh.colors, at.triangle, at.u, at.v);
    color *= {vertex.x, vertex.y, vertex.z};
  }
  return max(min(color, {1, 1, 1}), {0, 0, 0});
}

Vec3f emission(const Locus& at, const Material& material) {
  if (max_component(material.emission) <= 0) return {};
  const auto texel = at.sample(material.emission_texture, true);
  return texel ? material.emission * Vec3f{texel->x, texel->y, texel->z} : material.emission;
}

struct MetallicRoughness {
  float metallic, roughness;
};

MetallicRoughness metallic_roughness_at(const Locus& at, const Material& material) {
  MetallicRoughness result{material.metallic, material.roughness};
  if (const auto texel = at.sample(material.metallic_roughness_texture, false)) {
    result.roughness *= texel->y;
    result.metallic *= texel->z;
  }
  return result;
}

// The direction in which texture coordinate u grows, and its handedness; from the file, or from positions and uv.
std::optional<Vec4f> tangent_at(const Locus& at, int uv_set) {
  if (!at.mesh.tangents.empty()) return interpolate(at.mesh.tangents, at.triangle, at.u, at.v);
  const Triangle& t = at.triangle;
  const auto& p = at.mesh.positions;
  const auto& uv = at.mesh.uv[uv_set];
  const Vec3f e1 = p[t[1]] - p[t[0]], e2 = p[t[2]] - p[t[0]];
  const float du1 = uv[t[1]].x - uv[t[0]].x, dv1 = uv[t[1]].y - uv[t[0]].y;
  const float du2 = uv[t[2]].x - uv[t[0]].x, dv2 = uv[t[2]].y - uv[t[0]].y;
  const float det = du1 * dv2 - du2 * dv1;
  if (det == 0) return std::nullopt;
  const Vec3f d = (dv2 * e1 - dv1 * e2) / det;
  // v grows downwards in the picture, so that coordinates which are not mirrored turn the other way round.
  return Vec4f{d.x, d.y, d.z, det < 0 ? 1.0F : -1.0F};
}

struct NormalMap {
  const TextureUse& use;
  float scale;
};

// Normal maps, as glTF has them: +Y up in the texture, tangent space of the object's normal. A texture transform does
// not turn the tangents.
Vec3f mapped_normal(const Locus& at, const NormalMap& map, Vec3f object_normal) {
  const auto texel = at.sample(map.use, false);
  if (!texel) return object_normal;
  const auto tangent4 = tangent_at(at, map.use.uv_set);
  if (!tangent4) return object_normal;
  Vec3f tangent{tangent4->x, tangent4->y, tangent4->z};
  tangent = tangent - dot(tangent, object_normal) * object_normal;
  if (!(length_squared(tangent) > 0)) return object_normal;
  tangent = normalize(tangent);
  const Vec3f bitangent = tangent4->w * cross(object_normal, tangent);
  const Vec3f n = (map.scale * (2 * texel->x - 1)) * tangent + (map.scale * (2 * texel->y - 1)) * bitangent +
                  (2 * texel->z - 1) * object_normal;
  return length_squared(n) > 0 ? normalize(n) : object_normal;
}

// A shading normal about which the viewer's reflection would go into the surface, or that points into it itself, is
// bent towards the geometric normal until the reflection just leaves it. Source: Keller et al., The Iray Light
// Transport Simulation and Rendering System, 2017, appendix A.3.
Vec3f bend_for_reflection(Vec3f normal, Vec3f to_viewer, Vec3f geometric_normal) {
  constexpr float kLeast = 0.01F;  // cosine of a reflection, unless the viewer's own is about as small
  const float viewer_z = dot(to_viewer, geometric_normal);
  const float least = std::min(kLeast, 0.9F * viewer_z);
  const float normal_z = dot(normal, geometric_normal);
  if (normal_z > 0 && 2 * dot(normal, to_viewer) * normal_z - viewer_z >= least) return normal;
  // In the plane of both normals: n(φ) = cosφ Z + sinφ X reflects the viewer to the height A cos(2φ − δ).
  const Vec3f across = normal - normal_z * geometric_normal;
  if (!(length_squared(across) > 1e-12F)) return geometric_normal;
  const Vec3f x = normalize(across);
  const float viewer_x = dot(to_viewer, x), amplitude = std::hypot(viewer_x, viewer_z);
  const float phi = 0.5F * (std::atan2(viewer_x, viewer_z) + std::acos(std::min(1.0F, least / amplitude)));
  return normalize(std::cos(phi) * geometric_normal + std::sin(phi) * x);
}

struct ShadingNormals {
  Vec3f smooth;  // of the vertices
  Vec3f mapped;  // with the normal map
};

ShadingNormals shading_normals(const Locus& at, const NormalMap& map, const Mat4f& world_from_object, const Hit& hit) {
  const Vec3f n = interpolate(at.mesh.normals, at.triangle, at.u, at.v);
  if (!(length_squared(n) > 0)) return {hit.geometric_normal, hit.geometric_normal};
  const Vec3f object_normal = normalize(n);
  Vec3f smooth = transform_normal(world_from_object, object_normal);
  if (!(length_squared(smooth) > 0)) smooth = hit.geometric_normal;
  if (map.use.texture < 0) return {smooth, smooth};
  const Vec3f mapped = transform_normal(world_from_object, mapped_normal(at, map, object_normal));
  return {smooth, length_squared(mapped) > 0 ? mapped : smooth};
}

float scaled(const Locus& at, float factor, const TextureUse& use, float Vec4f::*channel) {
  if (!(factor > 0)) return factor;
  const auto texel = at.sample(use, false);
  return texel ? factor * ((*texel).*channel) : factor;
}

Vec3f scaled(const Locus& at, Vec3f factor, const TextureUse& use) {
  if (!(max_component(factor) > 0)) return factor;
  const auto texel = at.sample(use, true);
  return texel ? factor * Vec3f{texel->x, texel->y, texel->z} : factor;
}

float transmission_at(const Locus& at, const MaterialLayers& layers) {
  return scaled(at, layers.transmission, layers.transmission_texture, &Vec4f::x);
}

// All but the clearcoat's normal.
SurfaceLayers layers_at(const Locus& at, const MaterialLayers& m) {
  SurfaceLayers layers;
  layers.ior = m.ior;
  layers.specular = scaled(at, m.specular, m.specular_texture, &Vec4f::w);
  layers.specular_color = scaled(at, m.specular_color, m.specular_color_texture);
  layers.transmission = transmission_at(at, m);
  layers.solid = m.solid;
  layers.absorption = m.absorption;
  layers.clearcoat = scaled(at, m.clearcoat, m.clearcoat_texture, &Vec4f::x);
  layers.clearcoat_roughness = scaled(at, m.clearcoat_roughness, m.clearcoat_roughness_texture, &Vec4f::y);
  layers.sheen_color = scaled(at, m.sheen_color, m.sheen_color_texture);
  layers.sheen_roughness = scaled(at, m.sheen_roughness, m.sheen_roughness_texture, &Vec4f::w);
  return layers;
}

// What the polish lets out of the light that is emitted below it.
float below_clearcoat(const SurfaceLayers& layers, Vec3f to_viewer) {
  return 1 - layers.clearcoat * clearcoat_reflectance(std::abs(dot(layers.clearcoat_normal, to_viewer)));
}

using Corners = std::array<Vec3f, 3>;

// In world space; to the bit as the ray tracer has them where it draws the mesh once.
Corners world_corners(const Locus& at, const Mat4f& world_from_object) {
  Corners world;
  for (int k = 0; k < 3; ++k) world[k] = transform_point(world_from_object, at.mesh.positions[at.triangle[k]]);
  return world;
}

// Where the ray meets the triangle, clamped into it. In double, since barycentric floats may miss the place on a large
// triangle by more than what stands on it is thick; where the ray only grazes the plane, by them all the same.
// Source: Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.
Vec3f place_on(const Corners& corners, const Ray& ray, const Hit& hit) {
  constexpr double kFarther = 1e-5;  // apart than the rounding of the tracer's barycentrics takes them
  const Vec3d edge1 = Vec3d(corners[1]) - Vec3d(corners[0]), edge2 = Vec3d(corners[2]) - Vec3d(corners[0]);
  const Vec3d direction = Vec3d(ray.direction), from_corner = Vec3d(ray.origin) - Vec3d(corners[0]);
  const Vec3d across = cross(direction, edge2), along = cross(from_corner, edge1);
  const double determinant = dot(edge1, across);
  double u = dot(from_corner, across) / determinant, v = dot(direction, along) / determinant;
  if (!(std::abs(u - hit.u) < kFarther && std::abs(v - hit.v) < kFarther)) u = hit.u, v = hit.v;
  u = std::clamp(u, 0.0, 1.0), v = std::clamp(v, 0.0, 1 - u);
  return Vec3f(Vec3d(corners[0]) + u * edge1 + v * edge2);
}

float triangle_area(const Corners& corners) {
  return 0.5F * length(cross(corners[1] - corners[0], corners[2] - corners[0]));
}

// Of a ray's cone, in areas of the triangle that it meets there. It is not stretched by the angle of incidence.
float cone_footprint(const Ray& ray, float distance, const Corners& corners) {
  const float width = ray.cone_width + ray.cone_spread * distance;
  return width > 0 ? width * width / triangle_area(corners) : 0;
}

// Cosine between vertex normals and triangles from which on they are the same.
constexpr float kFlat = 0.999999F;

// From a triangle's point to the surface that its vertex normals stand for: the mean of its projections to the tangent
// planes of the corners, of those that it lies below.
// Source: Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, 2021.
Vec3f lift_to_smooth(const Locus& at, float side) {
  const float weights[3] = {1 - at.u - at.v, at.u, at.v};
  const Vec3f p = interpolate(at.mesh.positions, at.triangle, at.u, at.v);
  Vec3f lift;
  for (int k = 0; k < 3; ++k) {
    const Vec3f n = at.mesh.normals[at.triangle[k]];
    const float below = side * dot(p - at.mesh.positions[at.triangle[k]], n);
    if (below < 0) lift += (-weights[k] * below * side / length_squared(n)) * n;
  }
  return lift;
}

}  // namespace

float surface_alpha(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const Locus at = locus_at(scene, mesh, triangle, u, v);
  const Material& material = scene.materials[mesh.material];
  float alpha = material.alpha;
  const TextureUse& use = material.base_color_texture;
  if (use.texture >= 0 && !mesh.uv[use.uv_set].empty()) {
    alpha *= look_up_alpha(scene.textures[use.texture], at.uv_of(use));
  }
  if (!mesh.colors.empty()) alpha *= interpolate(mesh.colors, at.triangle, u, v).w;
  return alpha;
}

float surface_coverage(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const Material& material = scene.materials[mesh.material];
  if (material.alpha_mode == AlphaMode::kOpaque) return 1;
  const float alpha = surface_alpha(scene, mesh, triangle, u, v);
  if (material.alpha_mode == AlphaMode::kBlend) return std::clamp(alpha, 0.0F, 1.0F);
  return alpha >= material.alpha_cutoff ? 1 : 0;
}

bool surface_is_clear(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const Material& material = scene.materials[mesh.material];
  if (!material.layers || !(material.layers->transmission > 0)) return false;
  const Locus at = locus_at(scene, mesh, triangle, u, v);
  const MetallicRoughness mr = metallic_roughness_at(at, material);
  return mr.metallic < 1 && is_clear(mr.roughness) && transmission_at(at, *material.layers) > 0;
}

float clear_luminance(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, Vec2f uv, float cosine) {
  const Material& material = scene.materials[mesh.material];
  const Locus at = locus_at(scene, mesh, triangle, uv.x, uv.y);
  const MaterialLayers& layers = *material.layers;
  const float f0 = normal_reflectance(layers.ior) * luminance(layers.specular_color);
  const float reflected = layers.specular * std::min(1.0F, f0 + (1 - f0) * schlick_weight(cosine));
  const float dielectric = 1 - metallic_roughness_at(at, material).metallic;
  return dielectric * transmission_at(at, layers) * (1 - reflected) * luminance(base_color(at, material));
}

Vec3f surface_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  return emission(locus_at(scene, mesh, triangle, u, v), scene.materials[mesh.material]);
}

SurfacePoint make_surface_point(const Scene& scene, const Ray& ray, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene.meshes[instance.mesh];
  const Material& material = scene.materials[mesh.material];
  Locus at = locus_at(scene, mesh, hit.triangle, hit.u, hit.v);
  SurfacePoint point;
  const Corners corners = world_corners(at, instance.world_from_object);
  at.footprint = cone_footprint(ray, hit.distance, corners);
  point.position = place_on(corners, ray, hit);
  point.rounding =
      surface_rounding(triangle_extent(corners, mesh, hit.triangle, instance.world_from_object, hit.instanced));
  point.front = dot(hit.geometric_normal, ray.direction) <= 0;
  point.geometric_normal = (point.front ? 1.0F : -1.0F) * hit.geometric_normal;
  const Vec3f to_viewer = -normalize(ray.direction);
  const ShadingNormals normals =
      shading_normals(at, {material.normal_texture, material.normal_scale}, instance.world_from_object, hit);
  // The side is the geometry's to decide, and of mapped normals that of the smooth one: they may lean over the horizon.
  const float side = dot(normals.smooth, point.geometric_normal) < 0 ? -1.0F : 1.0F;
  point.smooth_normal = side * normals.smooth;
  point.shading_normal = bend_for_reflection(side * normals.mapped, to_viewer, point.geometric_normal);
  point.geometric_horizon = material.geometric_horizon;
  if (!material.geometric_horizon && dot(point.smooth_normal, point.geometric_normal) < kFlat) {
    point.lift = transform_direction(instance.world_from_object, lift_to_smooth(at, side));
  }
  point.base_color = base_color(at, material);
  point.lambert = material.lambert;
  const MetallicRoughness mr = metallic_roughness_at(at, material);
  point.metallic = mr.metallic;
  point.roughness = mr.roughness;
  point.unlit = material.unlit;
  point.emission = material.unlit ? point.base_color : emission(at, material);
  point.material = mesh.material;
  if (material.layers) {
    point.layers = layers_at(at, *material.layers);
    const NormalMap coat{material.layers->clearcoat_normal_texture, material.layers->clearcoat_normal_scale};
    const Vec3f normal =
        coat.use.texture < 0 ? normals.smooth : shading_normals(at, coat, instance.world_from_object, hit).mapped;
    point.layers->clearcoat_normal = bend_for_reflection(side * normal, to_viewer, point.geometric_normal);
    if (!material.unlit) point.emission *= below_clearcoat(*point.layers, to_viewer);
  }
  return point;
}

}  // namespace chiaro::renderer
