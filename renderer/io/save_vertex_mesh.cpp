#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <nlohmann/json.hpp>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/io/gltf_container.h"
#include "renderer/io/gltf_embed.h"
#include "renderer/io/vertex_mesh_file.h"

namespace chiaro::renderer {
namespace {

using nlohmann::ordered_json;

constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

// A GLB in the making: one buffer view per accessor.
struct Builder {
  ordered_json views = ordered_json::array(), accessors = ordered_json::array();
  ordered_json meshes = ordered_json::array(), nodes = ordered_json::array(), shown = ordered_json::array();
  std::string binary;

  template <class T>
  int add_accessor(const std::vector<T>& values, const char* type, int component_type, int target) {
    views.push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}, {"target", target}});
    binary.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    const std::size_t components = sizeof(T) / (component_type == kUnsignedShort ? 2 : 4);
    const std::size_t count = components == 3 && target == kElementArrayBuffer ? 3 * values.size() : values.size();
    accessors.push_back(
        {{"bufferView", views.size() - 1}, {"componentType", component_type}, {"count", count}, {"type", type}});
    return int(accessors.size()) - 1;
  }

  int add_floats(const std::vector<Vec3f>& values) { return add_accessor(values, "VEC3", kFloat, kArrayBuffer); }
  int add_floats(const std::vector<float>& values) { return add_accessor(values, "SCALAR", kFloat, kArrayBuffer); }
};

using ColorTexel = std::array<std::uint16_t, 4>;

std::uint16_t normalized(float value) { return std::uint16_t(std::lround(65535 * std::clamp(value, 0.0F, 1.0F))); }

std::vector<ColorTexel> display_colors(const std::vector<Vec3f>& illumination, float display_white) {
  const float scale = display_white > 0 ? 1 / display_white : 1;
  std::vector<ColorTexel> colors(illumination.size());
  std::transform(illumination.begin(), illumination.end(), colors.begin(), [&](Vec3f v) {
    return ColorTexel{normalized(scale * v.x), normalized(scale * v.y), normalized(scale * v.z), 65535};
  });
  return colors;
}

// glTF asks for the bounds of positions, as the floats are.
void set_bounds(ordered_json& accessor, const std::vector<Vec3f>& positions) {
  Box3f box;
  for (const Vec3f& p : positions) box.extend(p);
  accessor["min"] = {double(box.min.x), double(box.min.y), double(box.min.z)};
  accessor["max"] = {double(box.max.x), double(box.max.y), double(box.max.z)};
}

ordered_json make_primitive(Builder& builder, const VertexMeshPart& part, float display_white) {
  ordered_json attributes;
  attributes["POSITION"] = builder.add_floats(part.positions);
  set_bounds(builder.accessors.back(), part.positions);
  attributes["NORMAL"] = builder.add_floats(part.normals);
  if (!part.illumination.empty()) {
    attributes["COLOR_0"] =
        builder.add_accessor(display_colors(part.illumination, display_white), "VEC4", kUnsignedShort, kArrayBuffer);
    builder.accessors.back()["normalized"] = true;
    attributes["_ILLUMINATION"] = builder.add_floats(part.illumination);
  }
  if (!part.weight.empty()) attributes["_WEIGHT"] = builder.add_floats(part.weight);
  if (!part.standard_error.empty()) attributes["_STANDARD_ERROR"] = builder.add_floats(part.standard_error);
  ordered_json primitive = {{"attributes", attributes}, {"mode", part.triangles.empty() ? 0 : 4}};
  if (!part.triangles.empty()) {
    primitive["indices"] = builder.add_accessor(part.triangles, "SCALAR", kUnsignedInt, kElementArrayBuffer);
  }
  return primitive;
}

void check_part(const VertexMeshPart& part) {
  const auto fits = [&](std::size_t size) { return size == 0 || size == part.positions.size(); };
  CHIARO_CHECK(part.normals.size() == part.positions.size());
  CHIARO_CHECK(fits(part.illumination.size()) && fits(part.weight.size()) && fits(part.standard_error.size()));
}

void add_part(Builder& builder, const VertexMeshPart& part, float display_white) {
  check_part(part);
  ordered_json primitives = ordered_json::array({make_primitive(builder, part, display_white)});
  builder.shown.push_back(builder.nodes.size());
  builder.nodes.push_back({{"name", part.name}, {"mesh", builder.meshes.size()}});
  builder.meshes.push_back({{"name", part.name}, {"primitives", std::move(primitives)}});
}

// glTF has no empty arrays.
ordered_json document_of(Builder& builder) {
  ordered_json root = {{"asset", {{"version", "2.0"}, {"generator", "chiaro"}}}, {"scene", 0}};
  root["scenes"] = ordered_json::array({ordered_json::object()});
  if (builder.binary.empty()) return root;
  root["scenes"][0]["nodes"] = std::move(builder.shown);
  root["nodes"] = std::move(builder.nodes);
  root["meshes"] = std::move(builder.meshes);
  root["accessors"] = std::move(builder.accessors);
  root["bufferViews"] = std::move(builder.views);
  root["buffers"][0]["byteLength"] = builder.binary.size();
  return root;
}

}  // namespace

void save_vertex_mesh(const VertexMesh& mesh, const std::filesystem::path& path, float display_white) {
  Builder builder;
  for (const VertexMeshPart& part : mesh.parts) {
    if (!part.positions.empty()) add_part(builder, part, display_white);
  }
  GltfContainer container;
  container.json = document_of(builder).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  if (!builder.binary.empty()) container.binary = std::move(builder.binary);
  if (!writes_gltf_text(path)) return write_file_atomically(path, make_glb(container, path));
  write_file_atomically(path, embed(container.json, container.binary, {{path}, true}));
}

}  // namespace chiaro::renderer
