#pragma once
// Meshes as files have them, made into what the renderer asks for.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// What was repaired, to tell the user.
struct MeshRepairs {
  std::size_t degenerate_triangles = 0;  // dropped
  std::size_t bad_normals = 0;           // replaced by those of the surface
  std::size_t bad_tangent_meshes = 0;    // made without
  std::size_t bad_coordinates = 0;       // texture coordinates and colours that are not finite, replaced
  std::size_t bad_skin_weights = 0;      // vertices of skins whose weights were mended
  std::size_t spare_corners = 0;         // of no triangle, dropped
  MeshRepairs& operator+=(const MeshRepairs& other);
};

// Drops triangles of zero area and vertices that no triangle uses, makes flat normals where there are none (each
// triangle then has vertices of its own), and repairs normals, tangents, texture coordinates and colours that are not
// usable.
void repair_mesh(Mesh& mesh, MeshRepairs& repairs);

// Numbers the triangles' corners by the vertices that they use alone. Returns those, in their order, by the old
// numbers.
std::vector<std::uint32_t> keep_used_vertices(std::vector<Triangle>& triangles, std::size_t vertex_count);

// Tells slivers, however thin, from triangles of zero area.
bool has_area(const std::vector<Vec3f>& positions, const Triangle& triangle);

// Per vertex the sum of its triangles' normals weighted by area, unit length; (0, 1, 0) where that vanishes.
std::vector<Vec3f> smooth_normals(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles);

}  // namespace chiaro::renderer
