#pragma once
// glTF files as other programs might write them: triangles of three vertices with attributes of any name.

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.h"

namespace chiaro::inverse::tests {

struct ForeignNode {
  std::string name;
  std::vector<std::pair<std::string, std::vector<float>>> attributes;  // beside POSITION; 3 or 9 floats each
};

// A .gltf beside its .bin; every node is the triangle (0,0,0) (0,0,1) (1,0,0), moved up by one per node.
inline std::filesystem::path write_foreign_mesh(const test::TemporaryFolder& folder,
                                                const std::vector<ForeignNode>& nodes) {
  using nlohmann::json;
  std::string bytes;
  json gltf = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  json scene_nodes = json::array();
  const auto add_accessor = [&](const std::vector<float>& values, const json& extra) {
    const std::size_t view = gltf["bufferViews"].size();
    gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", 4 * values.size()}});
    json accessor = {{"bufferView", view}, {"componentType", 5126}, {"count", 3}};
    accessor["type"] = values.size() == 9 ? "VEC3" : "SCALAR";
    accessor.update(extra);
    gltf["accessors"].push_back(accessor);
    bytes.append(reinterpret_cast<const char*>(values.data()), 4 * values.size());
    return view;
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto y = float(i);
    json attributes;
    attributes["POSITION"] = add_accessor({0, y, 0, 0, y, 1, 1, y, 0}, {{"min", {0, y, 0}}, {"max", {1, y, 1}}});
    for (const auto& [name, values] : nodes[i].attributes) attributes[name] = add_accessor(values, json::object());
    gltf["meshes"].push_back({{"primitives", {{{"attributes", attributes}}}}});
    gltf["nodes"].push_back({{"name", nodes[i].name}, {"mesh", i}});
    scene_nodes.push_back(i);
  }
  gltf["scenes"] = {{{"nodes", scene_nodes}}};
  gltf["buffers"] = {{{"uri", "target.bin"}, {"byteLength", bytes.size()}}};
  folder.write("target.bin", bytes);
  return folder.write("target.gltf", gltf.dump());
}

}  // namespace chiaro::inverse::tests
