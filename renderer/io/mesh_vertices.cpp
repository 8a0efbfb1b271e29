#include "renderer/io/mesh_vertices.h"

namespace chiaro::renderer {
namespace {

template <class T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& sources) {
  if (values.empty()) return;
  std::vector<T> gathered(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) gathered[i] = values[sources[i]];
  values = std::move(gathered);
}

}  // namespace

void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& sources) {
  gather(mesh.positions, sources);
  gather(mesh.normals, sources);
  gather(mesh.tangents, sources);
  for (std::vector<Vec2f>& uv : mesh.uv) gather(uv, sources);
  gather(mesh.colors, sources);
}

}  // namespace chiaro::renderer
