#include "inverse/transport/receivers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "inverse/transport/receiver_samples.h"
#include "inverse/transport/split_edges.h"
#include "renderer/core/error.h"
#include "renderer/core/fingerprint.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

using renderer::Triangle;

constexpr double kDefaultCount = 30000;  // receivers aimed at by default …
constexpr double kDefaultGrowth = 1.3;   // … or this many times the scene's own vertices, where that is more
constexpr double kLeastOfWanted = 2.0 / 3, kMostOfWanted = 5.0 / 3;
constexpr float kShortestEdge = 1e-5F;  // of the scene's longest one
constexpr double kMostReceivers = 3e7;

SurfaceMesh world_mesh(const renderer::Scene& scene, const renderer::Instance& instance) {
  const renderer::Mesh& mesh = scene.meshes[instance.mesh];
  SurfaceMesh out;
  std::vector<std::uint32_t> used(mesh.positions.size(), ~0U);
  for (const Triangle& triangle : mesh.triangles) {
    Triangle t;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& index = used[triangle[k]];
      if (index == ~0U) {
        index = std::uint32_t(out.positions.size());
        out.positions.push_back(transform_point(instance.world_from_object, mesh.positions[triangle[k]]));
        out.normals.push_back(transform_normal(instance.world_from_object, mesh.normals[triangle[k]]));
      }
      t[k] = index;
    }
    out.triangles.push_back(t);
  }
  return out;
}

std::size_t vertex_count(const std::vector<SurfaceMesh>& meshes) {
  std::size_t count = 0;
  for (const SurfaceMesh& mesh : meshes) count += mesh.positions.size();
  return count;
}

std::size_t used_vertex_count(const renderer::Mesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) used[vertex] = true;
  }
  return std::size_t(std::count(used.begin(), used.end(), true));
}

// Before memory is taken for every instance of a mesh.
void check_own_vertices(const renderer::Scene& scene) {
  std::vector<double> of_mesh;
  for (const renderer::Mesh& mesh : scene.meshes) of_mesh.push_back(double(used_vertex_count(mesh)));
  double count = 0;
  for (const renderer::Instance& instance : scene.instances) count += of_mesh[instance.mesh];
  if (count <= kMostReceivers) return;
  throw renderer::Error(
      {scene.path, "receivers",
       fmt::format("the scene's own vertices, of {} instances, are {:.0f}", scene.instances.size(), count),
       fmt::format("at most {:.0f}: fewer instances or simpler meshes", kMostReceivers)});
}

std::vector<SurfaceMesh> split_all(std::vector<SurfaceMesh> meshes, float max_edge, const renderer::Control& control) {
  for (SurfaceMesh& mesh : meshes) split_long_edges(mesh, max_edge, control);
  return meshes;
}

double count_after_split(const std::vector<SurfaceMesh>& meshes, float max_edge, double limit) {
  double count = 0;
  for (const SurfaceMesh& mesh : meshes) {
    count += vertices_after_split(mesh, max_edge, limit - count);
    if (count > limit) break;
  }
  return count;
}

float longest_edge(const std::vector<SurfaceMesh>& meshes) {
  float longest = 0;
  for (const SurfaceMesh& mesh : meshes) {
    for (const Triangle& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        longest = std::max(longest, length(mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]));
      }
    }
  }
  return longest;
}

// The edge length that gives about as many receivers as wanted, by bisection of its logarithm. Where edges are alike,
// one step of their length doubles or quadruples the receivers: then rather too many than too few.
float default_max_edge(const std::vector<SurfaceMesh>& meshes) {
  const double wanted = std::max(kDefaultCount, kDefaultGrowth * double(vertex_count(meshes)));
  const double least = kLeastOfWanted * wanted, most = kMostOfWanted * wanted;
  float longest = longest_edge(meshes), shortest = kShortestEdge * longest;
  for (int step = 0; step < 12; ++step) {
    const float middle = std::sqrt(shortest) * std::sqrt(longest);
    (count_after_split(meshes, middle, wanted) >= wanted ? shortest : longest) = middle;
  }
  const double above = count_after_split(meshes, shortest, most), below = count_after_split(meshes, longest, wanted);
  const bool below_is_nearer = wanted / below < above / wanted;
  return below >= least && (below_is_nearer || above > most) ? longest : shortest;
}

// Between neighbours among floats no edge can be split.
void check_spacing(const renderer::Scene& scene, const std::vector<SurfaceMesh>& meshes, float max_edge) {
  constexpr float kLeastEdge = 4;
  float largest = 0;
  for (const SurfaceMesh& mesh : meshes) {
    for (const Vec3f& p : mesh.positions) largest = std::max(largest, max_component(abs(p)));
  }
  const float spacing = renderer::spacing_at(largest);
  if (max_edge >= kLeastEdge * spacing) return;
  throw renderer::Error(
      {scene.path, "receivers",
       fmt::format("edges of {:.3g} m where positions are {:.3g} m apart at least, {:.3g} m from the origin", max_edge,
                   spacing, largest),
       "a scene nearer to the origin, or a longer --max-edge"});
}

void check_count(const renderer::Scene& scene, const std::vector<SurfaceMesh>& meshes, float max_edge) {
  if (count_after_split(meshes, max_edge, kMostReceivers) <= kMostReceivers) return;
  throw renderer::Error({scene.path, "receivers",
                         fmt::format("edges of at most {} m make more than {:.3g} receivers", max_edge, kMostReceivers),
                         "a longer --max-edge"});
}

void append(Receivers& r, const std::string& name, std::span<const Vec3f> positions, std::span<const Vec3f> normals,
            std::span<const Triangle> triangles) {
  const auto base = std::uint32_t(r.size());
  r.parts.push_back({name, r.size(), positions.size(), r.triangles.size(), triangles.size()});
  r.positions.insert(r.positions.end(), positions.begin(), positions.end());
  r.normals.insert(r.normals.end(), normals.begin(), normals.end());
  for (const Triangle& t : triangles) r.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

// A normal that is zero (a singular transform, a broken file) is replaced by that of a face.
void repair_normals(Receivers& r) {
  const std::vector<std::uint32_t> face = largest_face_per_vertex(r);
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (length_squared(r.normals[i]) > 0.25F) continue;
    Vec3f n{0, 1, 0};
    if (face[i] != ~0U && length_squared(face_normal(r, r.triangles[face[i]])) > 0) {
      n = face_normal(r, r.triangles[face[i]]);
    }
    r.normals[i] = n;
  }
}

}  // namespace

Receivers make_receivers(const renderer::Scene& scene, const ReceiverOptions& options,
                         const renderer::Control& control) {
  check_own_vertices(scene);
  std::vector<SurfaceMesh> meshes;
  for (const renderer::Instance& instance : scene.instances) meshes.push_back(world_mesh(scene, instance));
  if (vertex_count(meshes) == 0) {
    throw renderer::Error({scene.path, "", "the scene has no triangles", "surfaces that light can fall on"});
  }
  const float max_edge = options.max_edge > 0 ? options.max_edge : default_max_edge(meshes);
  check_spacing(scene, meshes, max_edge);
  check_count(scene, meshes, max_edge);
  meshes = split_all(std::move(meshes), max_edge, control);
  Receivers receivers;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    control.stop_if_requested();
    append(receivers, scene.instances[i].name, meshes[i].positions, meshes[i].normals, meshes[i].triangles);
  }
  repair_normals(receivers);
  place_samples(receivers);
  return receivers;
}

Receivers receivers_from_mesh(const renderer::VertexMesh& mesh) {
  Receivers receivers;
  for (const renderer::VertexMeshPart& part : mesh.parts) {
    append(receivers, part.name, part.positions, part.normals, part.triangles);
  }
  repair_normals(receivers);
  place_samples(receivers);
  return receivers;
}

renderer::VertexMesh mesh_from_receivers(const Receivers& receivers) {
  renderer::VertexMesh mesh;
  for (const Receivers::Part& part : receivers.parts) {
    renderer::VertexMeshPart out;
    out.name = part.name;
    const auto first = receivers.positions.begin() + std::ptrdiff_t(part.first_receiver);
    const auto first_normal = receivers.normals.begin() + std::ptrdiff_t(part.first_receiver);
    out.positions.assign(first, first + std::ptrdiff_t(part.receiver_count));
    out.normals.assign(first_normal, first_normal + std::ptrdiff_t(part.receiver_count));
    const auto base = std::uint32_t(part.first_receiver);
    for (std::size_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      const Triangle& triangle = receivers.triangles[t];
      out.triangles.push_back({triangle[0] - base, triangle[1] - base, triangle[2] - base});
    }
    mesh.parts.push_back(std::move(out));
  }
  return mesh;
}

Receivers select_receivers(const Receivers& all, std::span<const std::size_t> chosen) {
  Receivers some;
  for (const std::size_t i : chosen) {
    some.positions.push_back(all.positions[i]);
    some.normals.push_back(all.normals[i]);
    some.samples.push_back(all.samples[i]);
  }
  return some;
}

std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t n = std::min(most, count);
  for (std::size_t k = 0; k < n; ++k) chosen.push_back((2 * k + 1) * count / (2 * n));
  return chosen;
}

std::string fingerprint(const Receivers& receivers) {
  renderer::Fingerprint f;
  f.add_all(std::span<const Vec3f>(receivers.positions));
  f.add_all(std::span<const Vec3f>(receivers.normals));
  f.add_all(std::span<const Triangle>(receivers.triangles));
  return f.text();
}

double fraction_on_surface(const renderer::RayTracer& tracer, const Receivers& receivers) {
  constexpr std::size_t kMostProbes = 2000;
  // Far from the origin samples stand off their surface, and surfaces off their places, by what rounding calls for.
  constexpr float kRoundings = 4;
  const renderer::Box3f& box = tracer.bounds();
  const float rounding = renderer::surface_rounding(max_component(max(abs(box.min), abs(box.max))), box.diagonal());
  const float reach = std::max(1e-3F * box.diagonal(), kRoundings * rounding);
  const std::size_t stride = std::max<std::size_t>(1, (receivers.size() + kMostProbes - 1) / kMostProbes);
  std::size_t probes = 0, found = 0;
  for (std::size_t i = 0; i < receivers.size(); i += stride, ++probes) {
    const renderer::SurfaceSample& s = receivers.samples[i];
    renderer::Ray ray{s.position + reach * s.normal, -s.normal, 0, 2 * reach};
    ray.meets_all = true;  // vertices may well lie in holes of masked surfaces, and on unlit ones
    found += tracer.intersect(ray).has_value() ? 1 : 0;
  }
  return probes > 0 ? double(found) / double(probes) : 0;
}

}  // namespace chiaro::inverse
