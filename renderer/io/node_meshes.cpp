#include "renderer/io/node_meshes.h"

#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "renderer/core/control.h"
#include "renderer/io/gltf_morph_targets.h"
#include "renderer/io/gltf_skins.h"
#include "renderer/io/gltf_variants.h"
#include "renderer/io/mesh_tangents.h"
#include "renderer/io/mesh_vertices.h"

namespace chiaro::renderer {
namespace {

// A primitive to read, in one shape.
struct Job {
  GltfPrimitiveRef ref;
  int skin = -1;
  std::vector<float> weights;
};

struct JobResult {
  std::optional<Mesh> mesh;
  MeshRepairs repairs;
  bool in_world = false;
};

struct JobList {
  std::vector<Job> jobs;
  std::vector<std::vector<std::size_t>> of_node;
};

JobList list_jobs(const GltfDocument& document, const std::vector<PlacedNode>& nodes) {
  JobList list;
  std::map<std::tuple<int, int, std::vector<float>>, std::vector<std::size_t>> known;
  for (const PlacedNode& node : nodes) {
    list.of_node.emplace_back();
    if (node.mesh < 0) continue;
    const auto [found, is_new] = known.try_emplace({node.mesh, node.skin, node.weights});
    const int count = is_new ? int(primitive_count(document, node.mesh)) : 0;
    for (int p = 0; p < count; ++p) {
      found->second.push_back(list.jobs.size());
      list.jobs.push_back({{node.mesh, p}, node.skin, node.weights});
    }
    list.of_node.back() = found->second;
  }
  return list;
}

std::vector<std::vector<Mat4f>> transforms_of_skins(const GltfDocument& document, const std::vector<Job>& jobs,
                                                    const std::vector<Mat4f>& world_from_nodes) {
  std::vector<std::vector<Mat4f>> skins(document.json.skins.size());
  for (const Job& job : jobs) {
    if (job.skin < 0 || !skins[std::size_t(job.skin)].empty()) continue;
    skins[std::size_t(job.skin)] = world_from_bind(document, job.skin, world_from_nodes);
  }
  return skins;
}

// Of the base layer, or of a clearcoat alone.
const TextureUse& normal_map_of(const Material& material) {
  const bool of_coat = material.normal_texture.texture < 0 && material.layers;
  return of_coat ? material.layers->clearcoat_normal_texture : material.normal_texture;
}

void make_missing_tangents(const Scene& scene, Mesh& mesh) {
  if (mesh.material < 0 || !mesh.tangents.empty()) return;
  const TextureUse& normal_map = normal_map_of(scene.materials[std::size_t(mesh.material)]);
  if (normal_map.texture < 0 || mesh.uv[std::size_t(normal_map.uv_set)].empty()) return;
  make_tangents(mesh, normal_map.uv_set);
}

class JobRunner {
 public:
  JobRunner(const GltfDocument& document, const Scene& scene, const std::vector<Job>& jobs, const NodeState& state)
      : document_(document),
        scene_(scene),
        skins_(transforms_of_skins(document, jobs, state.world_from_nodes)),
        variant_(state.variant) {}

  JobResult run(const Job& job) const {
    JobResult result;
    const std::vector<Mat4f>* const skin = job.skin < 0 ? nullptr : &skins_[std::size_t(job.skin)];
    std::optional<PosedPrimitive> posed = read_posed_primitive(document_, job.ref, job.weights, skin);
    if (!posed) return result;
    result.in_world = posed->in_world;
    result.repairs.bad_skin_weights = posed->mended_skin_weights;
    result.repairs.spare_corners = spare_corners(document_, job.ref);
    result.mesh = std::move(posed->mesh);
    result.mesh->material = material_in_variant(document_, job.ref, variant_, result.mesh->material);
    repair_mesh(*result.mesh, result.repairs);
    make_missing_tangents(scene_, *result.mesh);
    result.mesh->positions.reserve(result.mesh->positions.size() + 1);  // so that the ray tracer may share them
    return result;
  }

 private:
  const GltfDocument& document_;
  const Scene& scene_;
  std::vector<std::vector<Mat4f>> skins_;
  int variant_;
};

// Adds the results to the scene; returns their indices there, -1 for those without triangles.
std::vector<int> add_meshes(std::vector<JobResult>& results, Scene& scene) {
  std::vector<int> indices;
  int default_index = -1;
  for (JobResult& result : results) {
    indices.push_back(-1);
    if (!result.mesh || result.mesh->triangles.empty()) continue;
    if (result.mesh->material < 0) {
      if (default_index < 0) {
        default_index = int(scene.materials.size());
        scene.materials.push_back(default_material());
      }
      result.mesh->material = default_index;
    }
    indices.back() = int(scene.meshes.size());
    scene.meshes.push_back(*std::move(result.mesh));
    result.mesh.reset();
  }
  return indices;
}

}  // namespace

Material default_material() {
  Material material;
  material.name = "default";
  return material;
}

std::optional<PosedPrimitive> read_posed_primitive(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                                   const std::vector<float>& weights,
                                                   const std::vector<Mat4f>* world_from_bind) {
  std::optional<Mesh> mesh = read_primitive(document, ref);
  if (!mesh) return std::nullopt;
  PosedPrimitive posed;
  posed.mesh = *std::move(mesh);
  add_morph_targets(document, ref, weights, posed.mesh);
  posed.in_world = world_from_bind != nullptr && has_joints(document, ref);
  if (posed.in_world) posed.mended_skin_weights = skin_mesh(document, ref, *world_from_bind, posed.mesh);
  return posed;
}

NodeMeshList read_node_meshes(const GltfDocument& document, const std::vector<PlacedNode>& nodes,
                              const NodeState& state, Scene& scene) {
  const JobList list = list_jobs(document, nodes);
  const JobRunner runner(document, scene, list.jobs, state);
  std::vector<JobResult> results(list.jobs.size());
  parallel_for(list.jobs.size(), [&](std::size_t i) { results[i] = runner.run(list.jobs[i]); });
  NodeMeshList meshes;
  for (const JobResult& result : results) {
    meshes.repairs += result.repairs;
    meshes.without_triangles += result.mesh ? 0 : 1;
  }
  const std::vector<int> indices = add_meshes(results, scene);
  for (const std::vector<std::size_t>& jobs : list.of_node) {
    meshes.of_node.emplace_back();
    for (const std::size_t job : jobs) {
      if (indices[job] < 0) continue;
      NodeMeshes& shown = meshes.of_node.back();
      (results[job].in_world ? shown.in_world : shown.in_node).push_back(indices[job]);
    }
  }
  return meshes;
}

std::optional<Mesh> mesh_in_world(const Scene& scene, int index, const Mat4f& world_from_object) {
  Mesh mesh = scene.meshes[std::size_t(index)];
  const bool mirrored = determinant3(world_from_object) < 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) move_vertex(mesh, v, world_from_object, mirrored);
  for (Triangle& t : mesh.triangles) {
    if (mirrored) std::swap(t[1], t[2]);
  }
  MeshRepairs not_of_the_file;
  repair_mesh(mesh, not_of_the_file);
  if (mesh.triangles.empty()) return std::nullopt;
  make_missing_tangents(scene, mesh);
  return mesh;
}

}  // namespace chiaro::renderer
