#pragma once
// The primitives of glTF meshes as they are in the file, checked but not repaired.

#include <optional>
#include <string>

#include "renderer/io/gltf_document.h"
#include "renderer/scene/scene.h"

namespace chiaro::renderer {

struct GltfPrimitiveRef {
  int mesh = 0, primitive = 0;
};

std::size_t primitive_count(const GltfDocument& document, int mesh);

// "meshes[0].primitives[1]"
std::string place_of(const GltfPrimitiveRef& ref);

// Accessor of the attribute, or -1.
int find_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref, const std::string& name);

// Number of vertices; 0 without positions.
std::size_t vertex_count(const GltfDocument& document, const GltfPrimitiveRef& ref);

// Finite; empty where the primitive has none.
std::vector<Vec3f> read_positions(const GltfDocument& document, const GltfPrimitiveRef& ref);

// An attribute of as many elements as there are vertices; empty where the primitive has none.
std::vector<Vec3f> read_vec3_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                       const std::string& name);
std::vector<Vec4f> read_vec4_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                       const std::string& name);
std::vector<float> read_scalar_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                         const std::string& name);

// COLOR_0; alpha 1 where it has three components.
std::vector<Vec4f> read_colors(const GltfDocument& document, const GltfPrimitiveRef& ref);

// Triangle lists, strips and fans; absent for points and lines. Indices are those of vertices. To be called after
// read_positions, which finds out whether there are as many vertices as the file says.
std::optional<std::vector<Triangle>> read_triangles(const GltfDocument& document, const GltfPrimitiveRef& ref);

// Corners at the end that make no triangle.
std::size_t spare_corners(const GltfDocument& document, const GltfPrimitiveRef& ref);

// All of these as a mesh: normals, tangents, uv and colors empty where absent, material -1 where none is given.
// Absent for points, lines, and primitives without positions.
std::optional<Mesh> read_primitive(const GltfDocument& document, const GltfPrimitiveRef& ref);

}  // namespace chiaro::renderer
