#include "renderer/io/mesh_vertices.h"

namespace chiaro::renderer {
void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& sources) {
  gather(mesh.positions, sources);
  gather(mesh.normals, sources);
  gather(mesh.tangents, sources);
  for (std::vector<Vec2f>& uv : mesh.uv) gather(uv, sources);
  gather(mesh.colors, sources);
}

void move_vertex(Mesh& mesh, std::size_t v, const Mat4f& transform, bool mirrored) {
  mesh.positions[v] = transform_point(transform, mesh.positions[v]);
  if (!mesh.normals.empty()) mesh.normals[v] = transform_normal(transform, mesh.normals[v]);
  if (mesh.tangents.empty()) return;
  const Vec4f t = mesh.tangents[v];
  const Vec3f moved = transform_direction(transform, {t.x, t.y, t.z});
  mesh.tangents[v] = {moved.x, moved.y, moved.z, mirrored ? -t.w : t.w};
}

}  // namespace chiaro::renderer
