#include "renderer/io/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "renderer/io/mesh_vertices.h"

namespace chiaro::renderer {
namespace {

// Twice the area long. In double, so that products of floats neither round nor overflow.
Vec3d area_vector(const std::vector<Vec3f>& positions, const Triangle& t) {
  const Vec3d corner(positions[t[0]]);
  return cross(Vec3d(positions[t[1]]) - corner, Vec3d(positions[t[2]]) - corner);
}

Vec3f unit(const Vec3d& v) {
  const double l = length(v);
  return l > 0 ? Vec3f(v / l) : Vec3f{0, 1, 0};
}

std::size_t drop_degenerate_triangles(Mesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const Triangle& t) { return !has_area(mesh.positions, t); });
}

void drop_unused_vertices(Mesh& mesh) {
  const std::vector<std::uint32_t> sources = keep_used_vertices(mesh.triangles, mesh.positions.size());
  if (sources.size() < mesh.positions.size()) gather_vertices(mesh, sources);
}

void unshare_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> sources;
  sources.reserve(3 * mesh.triangles.size());
  for (Triangle& t : mesh.triangles) {
    sources.insert(sources.end(), t.begin(), t.end());
    const std::uint32_t first = std::uint32_t(sources.size()) - 3;
    t = {first, first + 1, first + 2};
  }
  gather_vertices(mesh, sources);
}

// glTF 2.0, section 3.7.2.1: without normals they are flat, and given tangents are ignored.
void make_flat_normals(Mesh& mesh) {
  mesh.tangents.clear();
  unshare_vertices(mesh);
  mesh.normals.resize(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3f normal = unit(area_vector(mesh.positions, t));
    for (const std::uint32_t v : t) mesh.normals[v] = normal;
  }
}

bool is_direction(double l) { return std::isfinite(l) && l > 1e-12; }

std::size_t repair_normals(Mesh& mesh) {
  std::size_t bad = 0;
  std::vector<Vec3f> smooth;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    Vec3f& n = mesh.normals[i];
    const double l = std::hypot(double(n.x), double(n.y), double(n.z));
    if (is_direction(l)) {
      n = {float(n.x / l), float(n.y / l), float(n.z / l)};
      continue;
    }
    if (smooth.empty()) smooth = smooth_normals(mesh.positions, mesh.triangles);
    n = smooth[i];
    ++bad;
  }
  return bad;
}

bool repair_tangents(Mesh& mesh) {
  for (Vec4f& t : mesh.tangents) {
    const double l = std::hypot(double(t.x), double(t.y), double(t.z));
    if (!is_direction(l) || !std::isfinite(t.w)) {
      mesh.tangents.clear();
      return false;
    }
    t = {float(t.x / l), float(t.y / l), float(t.z / l), t.w < 0 ? -1.0F : 1.0F};
  }
  return true;
}

std::size_t repair_uv(std::vector<Vec2f>& uv) {
  std::size_t bad = 0;
  for (Vec2f& c : uv) {
    if (std::isfinite(c.x) && std::isfinite(c.y)) continue;
    c = {0, 0};
    ++bad;
  }
  return bad;
}

std::size_t repair_colors(std::vector<Vec4f>& colors) {
  std::size_t bad = 0;
  for (Vec4f& c : colors) {
    for (float* channel : {&c.x, &c.y, &c.z, &c.w}) {
      bad += std::isfinite(*channel) ? 0 : 1;
      *channel = std::isfinite(*channel) ? std::clamp(*channel, 0.0F, 1.0F) : 1.0F;
    }
  }
  return bad;
}

}  // namespace

MeshRepairs& MeshRepairs::operator+=(const MeshRepairs& other) {
  degenerate_triangles += other.degenerate_triangles;
  bad_normals += other.bad_normals;
  bad_tangent_meshes += other.bad_tangent_meshes;
  bad_coordinates += other.bad_coordinates;
  bad_skin_weights += other.bad_skin_weights;
  spare_corners += other.spare_corners;
  return *this;
}

void repair_mesh(Mesh& mesh, MeshRepairs& repairs) {
  repairs.degenerate_triangles += drop_degenerate_triangles(mesh);
  drop_unused_vertices(mesh);
  if (mesh.normals.empty()) {
    make_flat_normals(mesh);
  } else {
    repairs.bad_normals += repair_normals(mesh);
  }
  repairs.bad_tangent_meshes += repair_tangents(mesh) ? 0 : 1;
  for (std::vector<Vec2f>& uv : mesh.uv) repairs.bad_coordinates += repair_uv(uv);
  repairs.bad_coordinates += repair_colors(mesh.colors);
}

std::vector<std::uint32_t> keep_used_vertices(std::vector<Triangle>& triangles, std::size_t vertex_count) {
  std::vector<std::uint32_t> new_index(vertex_count, 0), sources;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) new_index[v] = 1;
  }
  for (std::uint32_t v = 0; v < new_index.size(); ++v) {
    if (new_index[v] == 0) continue;
    new_index[v] = std::uint32_t(sources.size());
    sources.push_back(v);
  }
  if (sources.size() == vertex_count) return sources;
  for (Triangle& t : triangles) t = {new_index[t[0]], new_index[t[1]], new_index[t[2]]};
  return sources;
}

bool has_area(const std::vector<Vec3f>& positions, const Triangle& triangle) {
  return length(area_vector(positions, triangle)) != 0;
}

std::vector<Vec3f> smooth_normals(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles) {
  std::vector<Vec3d> sums(positions.size(), Vec3d{});
  for (const Triangle& t : triangles) {
    const Vec3d area = area_vector(positions, t);
    for (const std::uint32_t v : t) sums[v] += area;
  }
  std::vector<Vec3f> normals(positions.size());
  std::transform(sums.begin(), sums.end(), normals.begin(), unit);
  return normals;
}

}  // namespace chiaro::renderer
