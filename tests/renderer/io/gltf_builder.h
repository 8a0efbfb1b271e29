#pragma once
// glTF files made in code, for tests.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "renderer/io/gltf_container.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer::tests {

using nlohmann::ordered_json;
using test::error_of;
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

  // Each adds one and returns its index.
  int add_view(const std::string& bytes, int stride = 0);
  int add_accessor(const ordered_json& accessor);
  template <class T>
  int add_accessor(const std::vector<T>& values, int components, int component_type, bool normalized = false) {
    return add_accessor(bytes_of(values), values.size() / std::size_t(components), components, component_type,
                        normalized);
  }
  int add_accessor(const std::string& bytes, std::size_t count, int components, int component_type, bool normalized);
  int add_mesh(const ordered_json& attributes);  // of one primitive
  int add_node(const ordered_json& node);

  ordered_json& primitive(int mesh = 0);

  renderer::GltfContainer container() const;
  std::string glb() const;
};

// One triangle of area 1/2 in the plane z = 0, shown by one node.
GltfBuilder triangle_scene();

}  // namespace chiaro::renderer::tests
