#include "renderer/io/gltf_primitives.h"

#include <numeric>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/io/gltf_accessors.h"

namespace chiaro::renderer {
namespace {

const tinygltf::Primitive& primitive_of(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  return document.model->meshes[ref.mesh].primitives[ref.primitive];
}

std::string attribute_place(const GltfPrimitiveRef& ref, const std::string& name) {
  return fmt::format("{}.attributes.{}", place_of(ref), name);
}

// What whole numbers stand for of these is a part of the largest; joints are what they are.
void check_type(const GltfDocument& document, int accessor, const std::string& name, const std::string& place) {
  const bool joints = name.starts_with("JOINTS_"), normalized = document.model->accessors[accessor].normalized;
  const auto begins = [&](const char* attribute) { return name.starts_with(attribute); };
  if (joints && (normalized || !accessor_is_unsigned(document, accessor))) {
    fail(document, place, "has no whole numbers as they are", "unsigned bytes or shorts, not normalized");
  }
  if (!begins("NORMAL") && !begins("TANGENT") && !begins("COLOR_") && !begins("WEIGHTS_")) return;
  if (accessor_is_float(document, accessor) || normalized) return;
  fail(document, place, "has whole numbers that are not normalized", "floats or normalized ones");
}

// The accessor of an attribute that has one element per vertex, or -1.
int checked_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref, const std::string& name) {
  const int accessor = find_attribute(document, ref, name);
  if (accessor < 0) return -1;
  const std::size_t expected = vertex_count(document, ref), count = accessor_count(document, accessor);
  if (count != expected) {
    fail(document, attribute_place(ref, name), fmt::format("has {} elements", count),
         fmt::format("{}, as POSITION", expected));
  }
  check_type(document, accessor, name, attribute_place(ref, name));
  return accessor;
}

std::vector<Vec2f> read_uv(const GltfDocument& document, const GltfPrimitiveRef& ref, const std::string& name) {
  const int accessor = checked_attribute(document, ref, name);
  return accessor < 0 ? std::vector<Vec2f>{} : read_vec2(document, accessor, attribute_place(ref, name));
}

std::vector<std::uint32_t> corners(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  const std::size_t vertices = vertex_count(document, ref);
  const int accessor = find_attribute(document, ref, kIndicesAttribute);
  if (accessor < 0) {
    std::vector<std::uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }
  const std::string place = place_of(ref) + ".indices";
  std::vector<std::uint32_t> indices = read_indices(document, accessor, place);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < vertices) continue;
    fail(document, place, fmt::format("index {} is {}", i, indices[i]), fmt::format("less than {}", vertices));
  }
  return indices;
}

// glTF 2.0, section 3.7.2.1, with the winding that it gives each triangle.
std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& c, int mode) {
  std::vector<Triangle> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(c.size() / 3);
    for (std::size_t i = 0; i + 2 < c.size(); i += 3) triangles.push_back({c[i], c[i + 1], c[i + 2]});
  }
  for (std::size_t i = 0; mode == TINYGLTF_MODE_TRIANGLE_STRIP && i + 2 < c.size(); ++i) {
    triangles.push_back({c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]});
  }
  for (std::size_t i = 0; mode == TINYGLTF_MODE_TRIANGLE_FAN && i + 2 < c.size(); ++i) {
    triangles.push_back({c[i + 1], c[i + 2], c[0]});
  }
  return triangles;
}

}  // namespace

std::size_t primitive_count(const GltfDocument& document, int mesh) {
  return document.model->meshes[mesh].primitives.size();
}

std::string place_of(const GltfPrimitiveRef& ref) {
  return fmt::format("meshes[{}].primitives[{}]", ref.mesh, ref.primitive);
}

int find_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref, const std::string& name) {
  const auto& attributes = primitive_of(document, ref).attributes;
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

std::size_t vertex_count(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  const int positions = find_attribute(document, ref, "POSITION");
  return positions < 0 ? 0 : accessor_count(document, positions);
}

std::vector<Vec3f> read_positions(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  std::vector<Vec3f> positions = read_vec3_attribute(document, ref, "POSITION");
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (is_finite(positions[i])) continue;
    fail(document, attribute_place(ref, "POSITION"), fmt::format("vertex {} is not finite", i), "finite positions");
  }
  return positions;
}

std::vector<Vec3f> read_vec3_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                       const std::string& name) {
  const int accessor = checked_attribute(document, ref, name);
  return accessor < 0 ? std::vector<Vec3f>{} : read_vec3(document, accessor, attribute_place(ref, name));
}

std::vector<Vec4f> read_vec4_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                       const std::string& name) {
  const int accessor = checked_attribute(document, ref, name);
  return accessor < 0 ? std::vector<Vec4f>{} : read_vec4(document, accessor, attribute_place(ref, name));
}

std::vector<float> read_scalar_attribute(const GltfDocument& document, const GltfPrimitiveRef& ref,
                                         const std::string& name) {
  const int accessor = checked_attribute(document, ref, name);
  return accessor < 0 ? std::vector<float>{} : read_floats(document, accessor, 1, attribute_place(ref, name));
}

std::vector<Vec4f> read_colors(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  const int accessor = checked_attribute(document, ref, "COLOR_0");
  if (accessor < 0 || accessor_components(document, accessor) == 4) {
    return read_vec4_attribute(document, ref, "COLOR_0");
  }
  std::vector<Vec4f> colors;
  for (const Vec3f& c : read_vec3_attribute(document, ref, "COLOR_0")) colors.push_back({c.x, c.y, c.z, 1});
  return colors;
}

std::optional<std::vector<Triangle>> read_triangles(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  const int mode = primitive_of(document, ref).mode;
  if (mode < TINYGLTF_MODE_TRIANGLES) return std::nullopt;
  return triangles_of(corners(document, ref), mode);
}

std::size_t spare_corners(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  const int mode = primitive_of(document, ref).mode, accessor = find_attribute(document, ref, kIndicesAttribute);
  const std::size_t count = accessor < 0 ? vertex_count(document, ref) : accessor_count(document, accessor);
  if (mode < TINYGLTF_MODE_TRIANGLES) return 0;
  return mode == TINYGLTF_MODE_TRIANGLES ? count % 3 : count < 3 ? count : 0;
}

std::optional<Mesh> read_primitive(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  if (find_attribute(document, ref, "POSITION") < 0) return std::nullopt;
  if (primitive_of(document, ref).mode < TINYGLTF_MODE_TRIANGLES) return std::nullopt;
  Mesh mesh;
  mesh.name = document.model->meshes[ref.mesh].name;
  mesh.positions = read_positions(document, ref);
  mesh.normals = read_vec3_attribute(document, ref, "NORMAL");
  mesh.tangents = read_vec4_attribute(document, ref, "TANGENT");
  for (int n = 0; n < kUvSetCount; ++n) mesh.uv[n] = read_uv(document, ref, fmt::format("TEXCOORD_{}", n));
  mesh.colors = read_colors(document, ref);
  mesh.triangles = read_triangles(document, ref).value();
  mesh.material = primitive_of(document, ref).material;
  return mesh;
}

}  // namespace chiaro::renderer
