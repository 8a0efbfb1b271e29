#include "renderer/trace/ray_tracer.h"

#include <algorithm>
#include <array>

#include <embree3/rtcore.h>

#include "renderer/core/error.h"
#include "renderer/core/sampler.h"
#include "renderer/trace/fresnel.h"
#include "renderer/trace/surface_point.h"

namespace chiaro::renderer {
namespace {

// What all surfaces on a ray's way let through on average. Embree may show the same triangle more than once, as it may
// lie in several leaves.
class MeanPassage {
 public:
  struct Surface {
    unsigned geometry, instance, triangle;
    bool operator==(const Surface&) const = default;
  };

  void cross(Surface surface, float through) {
    const auto end = crossed_.begin() + std::ptrdiff_t(count_);
    if (through >= 1 || std::find(crossed_.begin(), end, surface) != end) return;
    if (count_ < crossed_.size()) crossed_[count_++] = surface;
    part_ *= through;
  }
  float part() const { return part_; }

 private:
  std::array<Surface, 64> crossed_;  // of more the same one may count twice; nothing may throw within Embree
  std::size_t count_ = 0;
  float part_ = 1;
};

struct RayContext {
  RTCIntersectContext embree;  // first: Embree hands this address to the filter
  std::uint32_t alpha_seed;
  ClearSurfaces clear;
  bool of_camera, meets_all;
  bool passed_clear = false;
  MeanPassage* mean = nullptr;  // if any, nothing is left to chance
};

struct GeometryUser {
  const Scene* scene;
  const Mesh* mesh;
  bool mirrored = false;  // its triangles are traced with the other side in front
};

// A hit that may be one, as a filter is shown it.
struct Candidate {
  const RTCFilterFunctionNArguments& arguments;
  const Scene& scene;
  const Mesh& mesh;
  const Material& material;
  std::uint32_t triangle;
  float u, v;
  bool mirrored;
};

Candidate candidate(const RTCFilterFunctionNArguments& arguments) {
  const auto& user = *static_cast<const GeometryUser*>(arguments.geometryUserPtr);
  RTCHitN* hit = arguments.hit;
  return {arguments,
          *user.scene,
          *user.mesh,
          user.scene->materials[user.mesh->material],
          RTCHitN_primID(hit, 1, 0),
          RTCHitN_u(hit, 1, 0),
          RTCHitN_v(hit, 1, 0),
          user.mirrored};
}

const RayContext& context_of(const Candidate& c) { return *reinterpret_cast<const RayContext*>(c.arguments.context); }

// Of the ray and the triangle.
std::uint32_t seed_of(const Candidate& c) {
  RTCHitN* hit = c.arguments.hit;
  const std::uint32_t surface = hash_combine(RTCHitN_geomID(hit, 1, 0), RTCHitN_instID(hit, 1, 0, 0));
  return hash_combine(hash_combine(context_of(c).alpha_seed, c.triangle), surface);
}

// Between the ray's direction and the triangle's normal.
float cosine_of(const Candidate& c) {
  RTCHitN* hit = c.arguments.hit;
  RTCRayN* ray = c.arguments.ray;
  const Vec3f normal{RTCHitN_Ng_x(hit, 1, 0), RTCHitN_Ng_y(hit, 1, 0), RTCHitN_Ng_z(hit, 1, 0)};
  const Vec3f direction{RTCRayN_dir_x(ray, 1, 0), RTCRayN_dir_y(ray, 1, 0), RTCRayN_dir_z(ray, 1, 0)};
  return dot(normal, direction) / std::sqrt(length_squared(normal) * length_squared(direction));
}

// A hit that the alpha does not hold is passed through. The part of all rays that it holds.
float held_by_alpha(const Candidate& c) { return surface_coverage(c.scene, c.mesh, c.triangle, c.u, c.v); }

bool alpha_holds(const Candidate& c) {
  const float held = held_by_alpha(c);
  return held >= 1 || (held > 0 && unit_float(seed_of(c)) < held);
}

bool shows_hidden_back(const Candidate& c) {
  return c.material.hidden_back && (c.mirrored ? cosine_of(c) < 0 : cosine_of(c) > 0);
}

// Luminance that a clear surface lets through; 0 of others.
float let_through(const Candidate& c) {
  if (!c.material.layers || !surface_is_clear(c.scene, c.mesh, c.triangle, c.u, c.v)) return 0;
  return clear_luminance(c.scene, c.mesh, c.triangle, {c.u, c.v}, std::abs(cosine_of(c)));
}

bool passes_clear(const Candidate& c, ClearSurfaces clear) {
  if (clear == ClearSurfaces::kStop || !c.material.layers) return false;
  const bool refracts = c.material.layers->solid && bends(c.material.layers->ior);
  if (clear == ClearSurfaces::kPassThin && refracts) return false;
  if (clear == ClearSurfaces::kPassByChance) return unit_float(hash_combine(seed_of(c), 1)) < let_through(c);
  return surface_is_clear(c.scene, c.mesh, c.triangle, c.u, c.v);
}

// Passed, unless next to nothing is left behind it.
bool passes_on_average(const Candidate& c, MeanPassage& mean) {
  constexpr float kNothing = 1e-6F;
  const float through = c.material.unlit ? 1 : 1 - held_by_alpha(c) * (1 - let_through(c));
  if (!(through > 0)) return false;
  RTCHitN* hit = c.arguments.hit;
  mean.cross({RTCHitN_geomID(hit, 1, 0), RTCHitN_instID(hit, 1, 0, 0), c.triangle}, through);
  return mean.part() > kNothing;
}

void filter_surface(const RTCFilterFunctionNArguments* arguments) {
  if (arguments->valid[0] != -1) return;
  auto& context = *reinterpret_cast<RayContext*>(arguments->context);
  if (context.meets_all) return;
  const Candidate c = candidate(*arguments);
  if (context.mean != nullptr) {
    if (passes_on_average(c, *context.mean)) arguments->valid[0] = 0;
    return;
  }
  if (!alpha_holds(c) || (context.of_camera ? shows_hidden_back(c) : c.material.unlit)) {
    arguments->valid[0] = 0;
  } else if (passes_clear(c, context.clear)) {
    context.passed_clear = true;
    arguments->valid[0] = 0;
  }
}

bool needs_filter(const Material& material) {
  const bool transmits = material.layers && material.layers->transmission > 0;
  return material.alpha_mode != AlphaMode::kOpaque || material.unlit || material.hidden_back || transmits;
}

RTCRay make_ray(const Ray& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.near, r.tfar = ray.far;
  r.mask = ~0U;
  return r;
}

RayContext make_context(const Ray& ray, bool coherent) {
  RayContext context;
  rtcInitIntersectContext(&context.embree);
  if (coherent) context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.alpha_seed = ray.alpha_seed;
  context.clear = ray.clear;
  context.of_camera = ray.of_camera;
  context.meets_all = ray.meets_all;
  return context;
}

bool is_blocked(RTCScene scene, const Ray& ray, RayContext& context) {
  RTCRay query = make_ray(ray);
  rtcOccluded1(scene, &context.embree, &query);
  return query.tfar < 0;
}

}  // namespace

// A mesh drawn once is put into the root scene in world space, so that its triangles share the root's hierarchy; a mesh
// drawn more often has a scene of its own, which the root instances.
struct RayTracer::Embree {
  RTCDevice device = nullptr;
  RTCScene root = nullptr;
  std::vector<RTCScene> mesh_scenes;
  std::vector<GeometryUser> users;                  // per mesh; stable addresses
  std::vector<std::uint32_t> instance_of_geometry;  // by root geometry id
  std::vector<Mat4f> world_from_object;             // by instance

  ~Embree() {
    for (RTCScene scene : mesh_scenes) {
      if (scene != nullptr) rtcReleaseScene(scene);
    }
    if (root != nullptr) rtcReleaseScene(root);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  // Where the mesh is already in the space of the target its own vertices are traced. Embree reads 16 bytes for each.
  void set_vertices(RTCGeometry geometry, const Mesh& mesh, const Mat4f& target_from_object) {
    const std::size_t count = mesh.positions.size();
    if (target_from_object.m == Mat4f{}.m && mesh.positions.capacity() > count) {
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                                 sizeof(Vec3f), count);
      return;
    }
    auto* vertices = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), count));
    if (vertices == nullptr) throw Error({"", "ray tracer", "not enough memory for the scene", ""});
    for (std::size_t i = 0; i < count; ++i) vertices[i] = transform_point(target_from_object, mesh.positions[i]);
  }

  RTCGeometry make_geometry(const Mesh& mesh, std::size_t user, const Mat4f& target_from_object) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    set_vertices(geometry, mesh, target_from_object);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(Triangle), mesh.triangles.size());
    users[user].mirrored = determinant3(target_from_object) < 0;
    rtcSetGeometryUserData(geometry, &users[user]);
    if (needs_filter(users[user].scene->materials[mesh.material])) {
      rtcSetGeometryIntersectFilterFunction(geometry, filter_surface);
      rtcSetGeometryOccludedFilterFunction(geometry, filter_surface);
    }
    rtcCommitGeometry(geometry);
    return geometry;
  }

  RTCScene make_scene() {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
  }

  void attach(RTCScene scene, RTCGeometry geometry) {
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCScene scene_of_mesh(const Scene& scene, int mesh) {
    if (mesh_scenes[mesh] == nullptr) {
      mesh_scenes[mesh] = make_scene();
      attach(mesh_scenes[mesh], make_geometry(scene.meshes[mesh], std::size_t(mesh), Mat4f{}));
      rtcCommitScene(mesh_scenes[mesh]);
    }
    return mesh_scenes[mesh];
  }

  void add_instance(const Scene& scene, std::uint32_t index, bool flatten) {
    const Instance& instance = scene.instances[index];
    RTCGeometry geometry;
    if (flatten) {
      geometry = make_geometry(scene.meshes[instance.mesh], std::size_t(instance.mesh), instance.world_from_object);
    } else {
      geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, scene_of_mesh(scene, instance.mesh));
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, instance.world_from_object.m.data());
      rtcCommitGeometry(geometry);
    }
    attach(root, geometry);
    instance_of_geometry.push_back(index);
    world_from_object.push_back(instance.world_from_object);
  }
};

RayTracer::RayTracer(const Scene& scene)
    : scene_(scene), bounds_(chiaro::renderer::bounds(scene)), embree_(std::make_unique<Embree>()) {
  embree_->device = rtcNewDevice(nullptr);
  if (embree_->device == nullptr) {
    const bool full = rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY;
    throw Error({"", "ray tracer", full ? "not enough memory" : "Embree cannot be started",
                 full ? "" : "memory, and a CPU that Embree supports"});
  }
  embree_->root = embree_->make_scene();
  embree_->mesh_scenes.assign(scene.meshes.size(), nullptr);
  for (const Mesh& mesh : scene.meshes) embree_->users.push_back({&scene, &mesh});
  const std::vector<int> uses = instances_per_mesh(scene);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    embree_->add_instance(scene, i, uses[scene.instances[i].mesh] == 1);
  }
  rtcCommitScene(embree_->root);
  if (rtcGetDeviceError(embree_->device) == RTC_ERROR_OUT_OF_MEMORY) {
    throw Error({"", "ray tracer", "not enough memory for the scene", ""});
  }
}

RayTracer::~RayTracer() = default;

std::optional<Hit> RayTracer::intersect(const Ray& ray) const {
  RayContext context = make_context(ray, false);
  RTCRayHit query;
  query.ray = make_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->root, &context.embree, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const bool instanced = query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const std::uint32_t instance = embree_->instance_of_geometry[instanced ? query.hit.instID[0] : query.hit.geomID];
  const Mat4f& world_from_object = embree_->world_from_object[instance];
  Vec3f normal{query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
  // Ng follows the order of the vertices as traced; a mirrored mesh turns its triangles round, as glTF has it.
  normal = instanced ? transform_normal(world_from_object, normal)
                     : unit_or(std::copysign(1.0F, determinant3(world_from_object)) * normal, {});
  if (normal == Vec3f{}) normal = -normalize(ray.direction);  // of a triangle that has no area in floats
  return Hit{query.ray.tfar, query.hit.u, query.hit.v, instance, query.hit.primID, normal, instanced};
}

Passage RayTracer::passage(const Ray& ray) const {
  RayContext context = make_context(ray, true);
  if (is_blocked(embree_->root, ray, context)) return Passage::kBlocked;
  return context.passed_clear ? Passage::kClear : Passage::kFree;
}

Ray ray_between(Vec3f from, Vec3f to, std::uint32_t alpha_seed) {
  return {from, to - from, 0, 1 - kShortOfLight, alpha_seed};
}

bool RayTracer::occluded_between(Vec3f from, Vec3f to, std::uint32_t alpha_seed) const {
  Ray ray = ray_between(from, to, alpha_seed);
  ray.clear = ClearSurfaces::kPassByChance;
  return occluded(ray);
}

float RayTracer::transmittance_between(Vec3f from, Vec3f to) const {
  const Ray ray = ray_between(from, to, 0);
  MeanPassage mean;
  RayContext context = make_context(ray, true);
  context.mean = &mean;
  return is_blocked(embree_->root, ray, context) ? 0 : mean.part();
}

float surface_rounding(float largest_coordinate, float radius) {
  // Embree's distance from a plane is a sum of products of corners, seen from the ray's start, with a normal whose
  // direction is the less certain the more obtuse the triangle. Of three million random rays from triangles of all
  // shapes and places, drawn once or as instances, none needed more than 6.
  constexpr float kUnits = 8, kUnitRoundoff = 0x1p-24F;
  return kUnits * kUnitRoundoff * (largest_coordinate + radius);
}

Vec3f offset_point(Vec3f point, Vec3f normal, float rounding) {
  // By the largest coordinate, not each by its own: on a wall at x = 0 the error of x is that of the others.
  constexpr float kLeastUnknown = 1.0F / 32;  // metres; where nothing but the point is known
  const float least = rounding > 0 ? 0 : kLeastUnknown;
  const float own = surface_rounding(std::max(max_component(abs(point)), least), 0);
  return point + std::max(rounding, own) * normal;
}

}  // namespace chiaro::renderer
