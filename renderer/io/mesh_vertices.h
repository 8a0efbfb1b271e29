#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// Value i becomes what value sources[i] was. Empty values stay so.
template <class T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& sources) {
  if (values.empty()) return;
  std::vector<T> gathered(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) gathered[i] = values[sources[i]];
  values = std::move(gathered);
}

// Makes new vertices out of those of a mesh: vertex i becomes what vertex sources[i] was. Triangles are the caller's.
void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& sources);

// Position, normal and tangent, the last two of any length. mirrored: the transform's determinant is negative.
void move_vertex(Mesh& mesh, std::size_t v, const Mat4f& transform, bool mirrored);

}  // namespace chiaro::renderer
