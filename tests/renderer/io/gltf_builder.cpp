#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

int append(ordered_json& list, ordered_json element) {
  list.push_back(std::move(element));
  return int(list.size()) - 1;
}

}  // namespace

int GltfBuilder::add_view(const std::string& bytes, int stride) {
  binary.resize((binary.size() + 3) / 4 * 4);
  ordered_json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (stride > 0) view["byteStride"] = stride;
  binary += bytes;
  return append(root["bufferViews"], view);
}

int GltfBuilder::add_accessor(const ordered_json& accessor) { return append(root["accessors"], accessor); }

int GltfBuilder::add_accessor(const std::string& bytes, std::size_t count, int components, int component_type,
                              bool normalized) {
  static const char* const kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const int view = add_view(bytes);
  ordered_json accessor = {
      {"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", kTypes[components]}};
  if (normalized) accessor["normalized"] = true;
  return add_accessor(accessor);
}

int GltfBuilder::add_mesh(const ordered_json& attributes) {
  return append(root["meshes"], {{"primitives", ordered_json::array({{{"attributes", attributes}}})}});
}

int GltfBuilder::add_node(const ordered_json& node) { return append(root["nodes"], node); }

ordered_json& GltfBuilder::primitive(int mesh) { return root["meshes"][std::size_t(mesh)]["primitives"][0]; }

renderer::GltfContainer GltfBuilder::container() const {
  ordered_json json = root;
  if (!binary.empty() && !json.contains("buffers")) json["buffers"][0]["byteLength"] = binary.size();
  renderer::GltfContainer result;
  result.json = json.dump();
  if (!binary.empty()) result.binary = binary;
  return result;
}

std::string GltfBuilder::glb() const { return renderer::make_glb(container(), "test.glb"); }

GltfBuilder triangle_scene() {
  GltfBuilder gltf;
  const int positions = gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3, kFloat);
  gltf.add_mesh({{"POSITION", positions}});
  gltf.add_node({{"mesh", 0}});
  return gltf;
}

}  // namespace chiaro::renderer::tests
