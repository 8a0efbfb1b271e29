#include "renderer/io/save_gltf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/io/gltf_container.h"
#include "renderer/io/gltf_embed.h"
#include "renderer/io/gltf_json.h"
#include "renderer/io/short_decimal.h"

namespace chiaro::renderer {
namespace {

using nlohmann::ordered_json;

constexpr const char* kExtension = "KHR_lights_punctual";

ordered_json json_of(Vec3f v) { return {short_decimal(v.x), short_decimal(v.y), short_decimal(v.z)}; }

bool is_empty(const ordered_json& object, const char* key) { return object.contains(key) && object[key].empty(); }

void remove_extension(ordered_json& object) {
  if (!object.contains("extensions")) return;
  object["extensions"].erase(kExtension);
  if (is_empty(object, "extensions")) object.erase("extensions");
}

void remove_name(ordered_json& root, const char* key, const char* name) {
  if (!root.contains(key)) return;
  ordered_json& names = root[key];
  names.erase(std::remove(names.begin(), names.end(), ordered_json(name)), names.end());
  if (names.empty()) root.erase(key);
}

// Channels of KHR_animation_pointer that lead to lights; those without channels left.
void remove_animations_of_lights(ordered_json& root) {
  constexpr const char* kPointer = "KHR_animation_pointer";
  const ordered_json::json_pointer pointer_of(std::string("/target/extensions/") + kPointer + "/pointer");
  const std::string lights = std::string("/extensions/") + kExtension + "/";
  if (!root.contains("animations")) return;
  bool any_left = false;
  std::erase_if(root["animations"].get_ref<ordered_json::array_t&>(), [&](ordered_json& animation) {
    auto& channels = animation["channels"].get_ref<ordered_json::array_t&>();
    std::erase_if(channels, [&](const ordered_json& channel) {
      const bool points = channel.contains(pointer_of) && channel[pointer_of].is_string();
      const bool to_light = points && channel[pointer_of].get_ref<const std::string&>().starts_with(lights);
      any_left |= points && !to_light;
      return to_light;
    });
    return channels.empty();
  });
  if (root["animations"].empty()) root.erase("animations");
  if (!any_left) remove_name(root, "extensionsUsed", kPointer), remove_name(root, "extensionsRequired", kPointer);
}

void remove_lights(ordered_json& root) {
  remove_animations_of_lights(root);
  remove_extension(root);
  if (root.contains("nodes")) {
    for (ordered_json& node : root["nodes"]) remove_extension(node);
  }
  remove_name(root, "extensionsUsed", kExtension);
  remove_name(root, "extensionsRequired", kExtension);
}

// Color and intensity of KHR_lights_punctual: the brightest channel is 1.
void set_intensity(ordered_json& light, Vec3f intensity) {
  const float largest = max_component(intensity);
  if (largest > 0) light["color"] = json_of(intensity / largest);
  light["intensity"] = short_decimal(largest);
}

// The shortest rotation that turns -Z into a unit direction.
ordered_json rotation_to(Vec3f direction) {
  const double x = direction.x, y = direction.y, z = direction.z;
  if (z > 1 - 1e-9) return {0.0, 1.0, 0.0, 0.0};
  // Half-way quaternion: (-Z × d, 1 + -Z · d), normalised.
  const double qx = y, qy = -x, qw = 1 - z, l = std::sqrt(qx * qx + qy * qy + qw * qw);
  return {qx / l, qy / l, 0.0, qw / l};
}

struct LightAndNode {
  ordered_json light, node;
};

LightAndNode make(const PointLight& light) {
  LightAndNode made{{{"type", "point"}}, {{"translation", json_of(light.position)}}};
  set_intensity(made.light, light.intensity);
  return made;
}

// glTF wants the inner angle less than the outer one.
LightAndNode make(const SpotLight& light) {
  const float outer = light.outer_cone_angle, inner = std::min(light.inner_cone_angle, std::nextafter(outer, 0.0F));
  LightAndNode made{{{"type", "spot"}},
                    {{"translation", json_of(light.position)}, {"rotation", rotation_to(light.direction)}}};
  made.light["spot"] = {{"innerConeAngle", short_decimal(inner)}, {"outerConeAngle", short_decimal(outer)}};
  set_intensity(made.light, light.intensity);
  return made;
}

LightAndNode make(const DirectionalLight& light) {
  LightAndNode made{{{"type", "directional"}}, {{"rotation", rotation_to(light.direction)}}};
  set_intensity(made.light, light.illuminance);
  return made;
}

LightAndNode make(const EnvironmentLight& light) {
  throw Error({"", fmt::format("light \"{}\"", light.name), "KHR_lights_punctual has no environments",
               "point, spot and directional lights"});
}

void use_extension(ordered_json& root) {
  ordered_json& used = root["extensionsUsed"];
  if (std::find(used.begin(), used.end(), kExtension) == used.end()) used.push_back(kExtension);
}

std::vector<std::size_t> root_nodes(const ordered_json& nodes) {
  std::set<std::size_t> children;
  for (const ordered_json& node : nodes) {
    for (const ordered_json& child : node.value("children", ordered_json::array())) {
      children.insert(child.get<std::size_t>());
    }
  }
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!children.contains(i)) roots.push_back(i);
  }
  return roots;
}

// A file without scenes gets one of all its root nodes.
void make_scene(ordered_json& root) {
  if (root.contains("scenes") && !root["scenes"].empty()) return;
  const std::vector<std::size_t> roots = root_nodes(root["nodes"]);
  root["scenes"] = ordered_json::array({ordered_json::object()});
  if (!roots.empty()) root["scenes"][0]["nodes"] = roots;
  root["scene"] = 0;
}

void add_light(ordered_json& root, const Light& light) {
  auto [definition, node] = std::visit([](const auto& l) { return make(l); }, light);
  if (!name_of(light).empty()) definition["name"] = node["name"] = name_of(light);
  ordered_json& definitions = root["extensions"][kExtension]["lights"];
  node["extensions"][kExtension]["light"] = definitions.size();
  definitions.push_back(std::move(definition));
  const std::size_t shown = root.value("scene", std::size_t{0});
  root["scenes"][shown]["nodes"].push_back(root["nodes"].size());
  root["nodes"].push_back(std::move(node));
}

void add_lights(ordered_json& root, const Lights& lights) {
  if (lights.empty()) return;
  if (!root.contains("nodes")) root["nodes"] = ordered_json::array();
  make_scene(root);
  for (const Light& light : lights) add_light(root, light);
  use_extension(root);
}

// Definitions that several nodes share become their own. A range, which the intensities given do not know of, would cut
// them off in other programs, and animations would change them.
void relight(ordered_json& root, const std::vector<int>& nodes, const Lights& lights) {
  CHIARO_CHECK(nodes.size() == lights.size());
  remove_animations_of_lights(root);
  const auto light_of = [](ordered_json& node) -> ordered_json* {
    const bool lit = node.contains("extensions") && node["extensions"].contains(kExtension);
    return lit ? &node["extensions"][kExtension]["light"] : nullptr;
  };
  std::map<std::size_t, int> uses;
  for (ordered_json& node : root["nodes"]) {
    if (const ordered_json* light = light_of(node)) ++uses[light->get<std::size_t>()];
  }
  ordered_json& definitions = root["extensions"][kExtension]["lights"];
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    ordered_json* const light = light_of(root["nodes"][std::size_t(nodes[k])]);
    CHIARO_CHECK(light != nullptr);
    if (uses[light->get<std::size_t>()] > 1) {
      definitions.push_back(ordered_json(definitions[light->get<std::size_t>()]));
      *light = definitions.size() - 1;
    }
    ordered_json& definition = definitions[light->get<std::size_t>()];
    set_intensity(definition, intensity_of(lights[k]));
    definition.erase("range");
  }
}

}  // namespace

void save_gltf_with_lights(const std::filesystem::path& scene_path, const Lights& lights,
                           const std::filesystem::path& path, const AddLightsOptions& options) {
  GltfContainer container = read_gltf_container(scene_path);
  check_gltf_json(container.json, scene_path);
  ordered_json root = ordered_json::parse(container.json);
  if (options.relit_nodes.empty()) {
    if (!options.keep_lights) remove_lights(root);
    add_lights(root, lights);
  } else {
    relight(root, options.relit_nodes, lights);
  }
  GltfEmbedding embedding{{scene_path, options.external}, writes_gltf_text(path)};
  container.json =
      embed(root.dump(-1, ' ', false, ordered_json::error_handler_t::replace), container.binary, embedding);
  write_file_atomically(path, embedding.as_text ? container.json : make_glb(container, path));
}

}  // namespace chiaro::renderer
