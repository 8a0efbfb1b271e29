#pragma once
// glTF files made in code, for tests.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "renderer/core/error.h"
#include "renderer/io/gltf_container.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer::tests {

using nlohmann::ordered_json;
using test::TemporaryFolder;

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kInt = 5124,
                     kUnsignedInt = 5125, kFloat = 5126;

struct GltfBuilder {
  ordered_json root = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  int add_view(const std::string& bytes, int stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    ordered_json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    binary += bytes;
    root["bufferViews"].push_back(view);
    return int(root["bufferViews"].size()) - 1;
  }

  int add_accessor(const ordered_json& accessor) {
    root["accessors"].push_back(accessor);
    return int(root["accessors"].size()) - 1;
  }

  template <class T>
  int add_accessor(const std::vector<T>& values, int components, int component_type, bool normalized = false) {
    static const char* const kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const int view = add_view(bytes_of(values));
    ordered_json accessor = {{"bufferView", view},
                             {"componentType", component_type},
                             {"count", values.size() / std::size_t(components)},
                             {"type", kTypes[components]}};
    if (normalized) accessor["normalized"] = true;
    return add_accessor(accessor);
  }

  // A mesh of one primitive; returns its index.
  int add_mesh(const ordered_json& attributes) {
    root["meshes"].push_back({{"primitives", ordered_json::array({{{"attributes", attributes}}})}});
    return int(root["meshes"].size()) - 1;
  }
  ordered_json& primitive(int mesh = 0) { return root["meshes"][std::size_t(mesh)]["primitives"][0]; }

  int add_node(const ordered_json& node) {
    root["nodes"].push_back(node);
    return int(root["nodes"].size()) - 1;
  }

  renderer::GltfContainer container() const {
    ordered_json json = root;
    if (!binary.empty() && !json.contains("buffers")) json["buffers"][0]["byteLength"] = binary.size();
    renderer::GltfContainer result;
    result.json = json.dump();
    if (!binary.empty()) result.binary = binary;
    return result;
  }

  std::string glb() const { return renderer::make_glb(container(), "test.glb"); }
};

// One triangle of area 1/2 in the plane z = 0, shown by one node.
inline GltfBuilder triangle_scene() {
  GltfBuilder gltf;
  const int positions = gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3, kFloat);
  gltf.add_mesh({{"POSITION", positions}});
  gltf.add_node({{"mesh", 0}});
  return gltf;
}

// The message of the Error that `action` throws; empty where it throws none.
template <class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const renderer::Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace chiaro::renderer::tests
