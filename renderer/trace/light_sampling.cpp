#include "renderer/trace/light_sampling.h"

#include <algorithm>

#include "renderer/trace/surface_point.h"

namespace chiaro::renderer {
namespace {

constexpr std::uint32_t kNoEmitter = ~0U;
constexpr float kNarrowestFall = 1e-6F;  // from a spot's inner cone to its outer, of the latter's versine

// The full sphere, or a spot's outer cone.
struct EmissionCone {
  Vec3f origin, axis{0, 0, 1};
  Vec3f intensity;
  float outer = 2;  // versine

  float solid_angle() const { return 2 * kPi * outer; }
};

// solid_angle() is 0 for a light that has no position.
EmissionCone emission_cone(const Light& light) {
  if (const auto* point = std::get_if<PointLight>(&light)) return {point->position, {0, 0, 1}, point->intensity, 2};
  if (const auto* spot = std::get_if<SpotLight>(&light)) {
    return {spot->position, spot->direction, spot->intensity, versine(spot->outer_cone_angle)};
  }
  return {{}, {0, 0, 1}, {}, 0};
}

// Of a point or spot light.
Vec3f intensity_towards(const Light& light, Vec3f direction) {
  const auto* spot = std::get_if<SpotLight>(&light);
  if (spot == nullptr) return std::get<PointLight>(light).intensity;
  return spot->intensity * spot_cone(*spot).falloff(versine(direction, spot->direction)).value;
}

struct PunctualVisitor {
  Vec3f point;

  PunctualSample operator()(const PointLight& light) const { return arriving(light.position, light.intensity); }

  PunctualSample operator()(const SpotLight& light) const {
    PunctualSample s = arriving(light.position, light.intensity);
    s.irradiance *= spot_cone(light).falloff(versine(-s.to_light, light.direction)).value;
    return s;
  }

  PunctualSample operator()(const DirectionalLight& light) const {
    return {-light.direction, kInfinity, light.illuminance};
  }

  PunctualSample operator()(const EnvironmentLight&) const { return {{0, 0, 1}, kInfinity, {}}; }

  PunctualSample arriving(Vec3f position, Vec3f intensity) const {
    const Vec3f d = position - point;
    const float d2 = length_squared(d);
    if (!(d2 > 0)) return {{0, 0, 1}, 0, {}};
    const float distance = std::sqrt(d2);
    return {d / distance, distance, intensity / d2};
  }
};

// What a surface emits there, times the part of it that alpha leaves.
Vec3f covered_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  return surface_coverage(scene, mesh, triangle, u, v) * surface_emission(scene, mesh, triangle, u, v);
}

// The same as what met that point sees, which a clearcoat leaves less of the flatter it is seen.
Vec3f covered_emission_towards(const Scene& scene, const Ray& ray, const Hit& hit) {
  const Mesh& mesh = scene.meshes[scene.instances[hit.instance].mesh];
  const auto& layers = scene.materials[mesh.material].layers;
  if (!layers || !(layers->clearcoat > 0)) return covered_emission(scene, mesh, hit.triangle, hit.u, hit.v);
  return surface_coverage(scene, mesh, hit.triangle, hit.u, hit.v) * make_surface_point(scene, ray, hit).emission;
}

// Mean luminance over a triangle of a texture, from a few points; never zero where anything may be emitted.
float mean_emission(const Scene& scene, const Mesh& mesh, std::uint32_t triangle) {
  constexpr float kPoints[][2] = {{1 / 3.F, 1 / 3.F}, {.1F, .1F},  {.8F, .1F}, {.1F, .8F},
                                  {.45F, .45F},       {.45F, .1F}, {.1F, .45F}};
  float sum = 0;
  for (const auto& p : kPoints) sum += luminance(covered_emission(scene, mesh, triangle, p[0], p[1]));
  return sum / float(std::size(kPoints)) + 0.02F * luminance(scene.materials[mesh.material].emission);
}

}  // namespace

SpotCone spot_cone(const SpotLight& light) {
  return {light.direction, versine(light.inner_cone_angle), versine(light.outer_cone_angle)};
}

float SpotCone::fall() const { return std::max(kNarrowestFall * outer, outer - inner); }

SpotCone::Falloff SpotCone::falloff(float versine) const {
  const float t = std::clamp((outer - versine) / fall(), 0.0F, 1.0F);
  return {t * t, t > 0 && t < 1 ? -2 * t / fall() : 0};
}

PunctualSample sample_punctual(const Light& light, Vec3f point) { return std::visit(PunctualVisitor{point}, light); }

PunctualEmission::PunctualEmission(const Lights& lights) : lights_(lights) {
  for (const Light& light : lights) {
    const EmissionCone cone = emission_cone(light);
    power_.push_back(double(cone.solid_angle()) * double(max_component(cone.intensity)));
    power_end_.push_back((power_end_.empty() ? 0 : power_end_.back()) + power_.back());
  }
}

PunctualEmission::Sample PunctualEmission::sample(float pick, Vec2f u) const {
  const double at = std::min(double(pick), 1 - 1e-9) * power_end_.back();
  const auto chosen = std::size_t(std::upper_bound(power_end_.begin(), power_end_.end(), at) - power_end_.begin());
  const EmissionCone cone = emission_cone(lights_[chosen]);
  const float versine = u.x * cone.outer, sine = std::sqrt(versine * (2 - versine)), phi = 2 * kPi * u.y;
  const Vec3f direction{sine * std::cos(phi), sine * std::sin(phi), 1 - versine};
  Sample s{chosen, cone.origin, Frame3f(cone.axis).world_from_local(direction), {}};
  s.direction = normalize(s.direction);
  s.intensity = intensity_towards(lights_[chosen], s.direction);
  return s;
}

float PunctualEmission::pdf(std::size_t light, Vec3f direction) const {
  if (!(power_[light] > 0)) return 0;
  const EmissionCone cone = emission_cone(lights_[light]);
  if (versine(direction, cone.axis) > cone.outer && cone.outer < 2) return 0;
  return float(power_[light] / (power_end_.back() * double(cone.solid_angle())));
}

EmissiveTriangles::EmissiveTriangles(const Scene& scene) : scene_(scene), emitter_(scene.instances.size()) {
  std::vector<LightBounds> bounds;
  const std::vector<int> uses = instances_per_mesh(scene);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    add_instance(i, uses[scene.instances[i].mesh] > 1, bounds);
  }
  tree_ = LightTree(bounds);
}

void EmissiveTriangles::add_instance(std::uint32_t index, bool instanced, std::vector<LightBounds>& bounds) {
  const Instance& instance = scene_.instances[index];
  const Mesh& mesh = scene_.meshes[instance.mesh];
  if (max_component(scene_.materials[mesh.material].emission) <= 0) return;
  emitter_[index].assign(mesh.triangles.size(), kNoEmitter);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3f, 3> p;
    LightBounds b;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = transform_point(instance.world_from_object, mesh.positions[mesh.triangles[t][k]]);
      b.box.extend(p[k]);
    }
    // In double: a lamp may be so small that floats have no square of its area, and shine all the same.
    const Vec3d n = cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0]));
    const double twice_area = length(n);
    const auto area = float(0.5 * twice_area);
    if (!(area > 0)) continue;
    b.axis = Vec3f(n / twice_area);
    b.spread = 0;
    b.two_sided = true;
    b.intensity = area * mean_emission(scene_, mesh, t);
    emitter_[index][t] = std::uint32_t(triangles_.size());
    triangles_.push_back(
        {index, t, p[0], p[1], p[2], b.axis, area, triangle_extent(p, mesh, t, instance.world_from_object, instanced)});
    bounds.push_back(b);
  }
}

EmissiveTriangles::Sample EmissiveTriangles::sample(Vec3f point, Vec3f normal, double pick, Vec2f u) const {
  const auto found = tree_.pick(point, normal, pick);
  if (!found) return {};
  const Emitter& e = triangles_[found->light];
  const float root = std::sqrt(u.x);
  const float bu = root * (1 - u.y), bv = root * u.y;
  const Vec3f p = (1 - bu - bv) * e.p0 + bu * e.p1 + bv * e.p2;
  const Vec3f d = p - point;
  const float d2 = length_squared(d);
  if (!(d2 > 0)) return {};
  Sample s;
  s.distance = std::sqrt(d2);
  s.to_light = d / s.distance;
  const float cosine = std::abs(dot(s.to_light, e.normal));
  if (!(cosine > 1e-7F)) return {};
  // Where floats can tell that the ray has not yet met the triangle.
  const float rounding = surface_rounding(e.extent.largest_coordinate, e.extent.circle_radius + s.distance);
  s.reach = s.distance - std::min(2 * rounding / cosine, 0.5F * s.distance);
  s.radiance = covered_emission_towards(scene_, {.origin = point, .direction = s.to_light},
                                        {s.distance, bu, bv, std::uint32_t(e.instance), e.triangle, e.normal, false});
  s.pdf = found->probability / e.area * d2 / cosine;
  return s;
}

float EmissiveTriangles::pdf(const Hit& hit, Vec3f point, Vec3f normal, Vec3f hit_position) const {
  const auto& emitters = emitter_[hit.instance];
  if (emitters.empty() || emitters[hit.triangle] == kNoEmitter) return 0;
  const std::uint32_t emitter = emitters[hit.triangle];
  const Vec3f d = hit_position - point;
  const float d2 = length_squared(d);
  const float cosine = std::abs(dot(d, hit.geometric_normal)) / std::sqrt(d2);
  if (!(cosine > 1e-7F)) return 0;
  return tree_.probability(emitter, point, normal) / triangles_[emitter].area * d2 / cosine;
}

}  // namespace chiaro::renderer
