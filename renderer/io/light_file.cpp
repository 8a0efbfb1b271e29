#include "renderer/io/light_file.h"

#include <cmath>
#include <set>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/external_files.h"
#include "renderer/core/shortened.h"
#include "renderer/core/world_limits.h"
#include "renderer/io/environment_file.h"
#include "renderer/io/gltf_container.h"
#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_environment.h"
#include "renderer/io/gltf_lights.h"
#include "renderer/io/json_text.h"
#include "renderer/io/short_decimal.h"

namespace chiaro::renderer {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kDefaultType = "point";

using OcioConfig = std::optional<std::filesystem::path>;

// One light of a JSON file, with what messages about it need.
struct Entry {
  const json& fields;
  std::string file;
  std::string place;  // "lights[2]"
  const OcioConfig& config;
};

[[noreturn]] void fail(const Entry& entry, const char* field, const std::string& problem, const std::string& expected) {
  throw Error({entry.file, fmt::format("{}.{}", entry.place, field), problem, expected});
}

float checked_float(const Entry& entry, const char* field, const json& value, const std::string& expected) {
  if (!value.is_number()) fail(entry, field, "is of the wrong type", expected);
  const float number = value.get<float>();
  if (!std::isfinite(number)) fail(entry, field, "is not finite", expected);
  return number;
}

Vec3f read_vec3(const Entry& entry, const char* field, const std::string& expected) {
  const auto value = entry.fields.find(field);
  if (value == entry.fields.end()) fail(entry, field, "is missing", expected);
  if (!value->is_array() || value->size() != 3) fail(entry, field, "is of the wrong type", expected);
  Vec3f result;
  for (int axis = 0; axis < 3; ++axis) result[axis] = checked_float(entry, field, (*value)[axis], expected);
  return result;
}

Vec3f read_position(const Entry& entry) {
  const Vec3f position = read_vec3(entry, "position", "three numbers, metres");
  if (in_world(position)) return position;
  fail(entry, "position", "is too far away", fmt::format("within {:g} m of the origin", kWorldLimit));
}

Vec3f read_intensity(const Entry& entry, const char* unit) {
  const std::string expected = fmt::format("three numbers, not negative, {}", unit);
  const Vec3f intensity = read_vec3(entry, "intensity", expected);
  if (min_component(intensity) < 0) fail(entry, "intensity", "is negative", expected);
  if (max_component(intensity) > kBrightest) {
    fail(entry, "intensity", "is too bright", fmt::format("at most {:g} {}", kBrightest, unit));
  }
  return intensity;
}

Vec3f read_direction(const Entry& entry) {
  const Vec3f d = read_vec3(entry, "direction", "three numbers");
  const double l = std::hypot(double(d.x), double(d.y), double(d.z));
  if (!(l > 0)) fail(entry, "direction", "is zero", "a direction");
  // What is a unit vector already stays as it was written.
  if (std::abs(l - 1) <= 1e-6) return d;
  return {float(d.x / l), float(d.y / l), float(d.z / l)};
}

float read_angle(const Entry& entry, const char* field, float otherwise) {
  const auto value = entry.fields.find(field);
  if (value == entry.fields.end()) return otherwise;
  const float angle = checked_float(entry, field, *value, "radians");
  if (angle < 0 || angle > kPi / 2) fail(entry, field, fmt::format("is {}", angle), "0 to π/2 radians");
  return angle;
}

std::string read_string(const Entry& entry, const char* field, const std::string& otherwise) {
  const auto value = entry.fields.find(field);
  if (value == entry.fields.end()) return otherwise;
  if (!value->is_string()) fail(entry, field, "is of the wrong type", "a string");
  return value->get<std::string>();
}

SpotLight read_spot(const Entry& entry, const std::string& name) {
  SpotLight light;
  light.name = name;
  light.position = read_position(entry);
  light.direction = read_direction(entry);
  light.intensity = read_intensity(entry, "candela");
  light.inner_cone_angle = read_angle(entry, "inner_cone_angle", light.inner_cone_angle);
  light.outer_cone_angle = read_angle(entry, "outer_cone_angle", light.outer_cone_angle);
  if (light.outer_cone_angle <= 0 || light.inner_cone_angle > light.outer_cone_angle) {
    fail(entry, "outer_cone_angle", fmt::format("is {}", light.outer_cone_angle),
         "more than 0 and not less than inner_cone_angle");
  }
  return light;
}

// Within the file's own folder: a light file from elsewhere does not open what it likes.
std::filesystem::path read_image_path(const Entry& entry) {
  const std::string expected = "the name of an image in the light file's folder";
  const std::string name = read_string(entry, "image", "");
  const std::filesystem::path image = std::filesystem::path(name).lexically_normal();
  if (name.empty()) fail(entry, "image", "is missing", expected);
  const std::filesystem::path folder = std::filesystem::path(entry.file).parent_path(), file = folder / image;
  const bool leads_out = image.is_absolute() || *image.begin() == "..";
  std::error_code unknown;
  if (leads_out || (std::filesystem::exists(file, unknown) && !is_in_folder(file, folder))) {
    fail(entry, "image", fmt::format("\"{}\" is outside the light file's folder", shortened(name, 200)), expected);
  }
  return file;
}

float read_factor(const Entry& entry, const char* field, float low, float high, const std::string& expected) {
  const auto value = entry.fields.find(field);
  const float factor = checked_float(entry, field, *value, expected);
  if (factor < low || factor > high) fail(entry, field, fmt::format("is {}", factor), expected);
  return factor;
}

EnvironmentLight read_environment_light(const Entry& entry, std::vector<std::string>& warnings) {
  EnvironmentLight light = load_environment(read_image_path(entry), warnings, entry.config);
  light.name = read_string(entry, "name", light.name);
  if (entry.fields.contains("rotation")) {
    light.rotation = read_factor(entry, "rotation", -2 * kPi, 2 * kPi, "-2π to 2π radians");
  }
  if (entry.fields.contains("intensity")) {
    light.intensity = read_factor(entry, "intensity", 0, 1e15F, "one number, not negative, cd/m² of a pixel of 1");
  }
  return light;
}

Light read_light(const Entry& entry, const std::string& default_name, std::vector<std::string>& warnings) {
  if (!entry.fields.is_object()) throw Error({entry.file, entry.place, "is not an object", "a light"});
  const std::string type = read_string(entry, "type", kDefaultType), name = read_string(entry, "name", default_name);
  if (type == "point") return PointLight{name, read_position(entry), read_intensity(entry, "candela")};
  if (type == "spot") return read_spot(entry, name);
  if (type == "directional") return DirectionalLight{name, read_direction(entry), read_intensity(entry, "lux")};
  if (type == "environment") return read_environment_light(entry, warnings);
  fail(entry, "type", fmt::format("is \"{}\"", type.substr(0, 40)), "point, spot, directional or environment");
}

using FieldNames = std::set<std::string_view>;

// What a light of a type may have. A solve's summary says more of each.
FieldNames known_fields(const std::string& type) {
  FieldNames known{"type", "name", "intensity", "contribution", "interval_90"};
  if (type == "point" || type == "spot") known.insert("position");
  if (type == "spot" || type == "directional") known.insert("direction");
  if (type == "spot") known.merge(FieldNames{"inner_cone_angle", "outer_cone_angle"});
  if (type == "environment") known.merge(FieldNames{"image", "rotation"});
  return known;
}

// Each once. Of lights whose type is known.
std::set<std::string> unknown_fields(const json& lights) {
  std::set<std::string> unknown;
  for (const json& light : lights) {
    const FieldNames known = known_fields(light.value("type", kDefaultType));
    for (const auto& [name, value] : light.items()) {
      if (!known.contains(name)) unknown.insert(name.substr(0, 40));
    }
  }
  return unknown;
}

json parse(const std::string& text, const std::string& file) {
  check_json_text(text, file);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    throw Error({file, "JSON", fmt::format("syntax error at byte {}", error.byte), "a light file"});
  } catch (const json::exception&) {
    throw Error({file, "JSON", "holds a number that is out of range", "a light file"});
  }
}

Lights read_json_lights(const json& root, const std::string& file, const OcioConfig& config,
                        std::vector<std::string>& warnings) {
  const bool missing = !root.is_object() || !root.contains("lights");
  if (missing || !root["lights"].is_array()) {
    throw Error({file, "lights", missing ? "is missing" : "is not an array", "a light file, {\"lights\":[…]}"});
  }
  Lights lights;
  for (const json& fields : root["lights"]) {
    const std::size_t index = lights.size();
    const Entry entry{fields, file, fmt::format("lights[{}]", index), config};
    lights.push_back(read_light(entry, fmt::format("light {}", index), warnings));
  }
  if (const std::set<std::string> unknown = unknown_fields(root["lights"]); !unknown.empty()) {
    warnings.push_back(fmt::format("{}: not read of its lights: {}", file, fmt::join(unknown, ", ")));
  }
  return lights;
}

Lights read_gltf_lights(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  GltfDocument document = open_gltf(path);
  Lights lights = read_lights(document, place_nodes(document), warnings).lights;
  if (has_environment(document)) {
    load_buffers(document);
    if (auto environment = read_environment(document, warnings)) lights.push_back(*std::move(environment));
  }
  return lights;
}

ordered_json json_of(Vec3f v) { return {short_decimal(v.x), short_decimal(v.y), short_decimal(v.z)}; }

ordered_json json_of(const PointLight& light) {
  return {{"type", "point"}, {"position", json_of(light.position)}, {"intensity", json_of(light.intensity)}};
}

ordered_json json_of(const SpotLight& light) {
  return {{"type", "spot"},
          {"position", json_of(light.position)},
          {"direction", json_of(light.direction)},
          {"intensity", json_of(light.intensity)},
          {"inner_cone_angle", short_decimal(light.inner_cone_angle)},
          {"outer_cone_angle", short_decimal(light.outer_cone_angle)}};
}

ordered_json json_of(const DirectionalLight& light) {
  return {{"type", "directional"}, {"direction", json_of(light.direction)}, {"intensity", json_of(light.illuminance)}};
}

ordered_json json_of(const EnvironmentLight& light) {
  return {{"type", "environment"},
          {"image", light.image},
          {"rotation", short_decimal(light.rotation)},
          {"intensity", short_decimal(light.intensity)}};
}

ordered_json json_of(const Light& light) {
  ordered_json fields = std::visit([](const auto& l) { return json_of(l); }, light);
  if (!name_of(light).empty()) fields["name"] = name_of(light);
  return fields;
}

// The image's name from the light file's folder.
std::string image_beside(const EnvironmentLight& light, const std::filesystem::path& path) {
  const auto folder = std::filesystem::absolute(path).parent_path().lexically_normal();
  const auto image = std::filesystem::absolute(light.image).lexically_normal().lexically_relative(folder);
  if (light.image.empty() || image.empty() || *image.begin() == "..") {
    throw Error({path.string(), fmt::format("light \"{}\"", light.name), "has no image in the light file's folder",
                 "an environment read from there"});
  }
  return image.string();
}

// Names that are not UTF-8 do not stop a light from being saved.
std::string dumped(const Light& light, const std::filesystem::path& path) {
  ordered_json fields = json_of(light);
  if (is_environment(light)) fields["image"] = image_beside(std::get<EnvironmentLight>(light), path);
  return fields.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

Lights load_lights(const std::filesystem::path& path, std::vector<std::string>& warnings, const OcioConfig& config) {
  const std::string bytes = read_file(path);
  const bool binary = is_glb(bytes);
  const json root = binary ? json() : parse(bytes, path.string());
  const bool gltf = binary || (root.is_object() && root.contains("asset"));
  if (gltf) require_rereadable(path, "a regular file, or a JSON light file: glTF is read in parts");
  Lights lights = gltf ? read_gltf_lights(path, warnings) : read_json_lights(root, path.string(), config, warnings);
  if (lights.empty()) throw Error({path.string(), "lights", "there are none", "at least one light"});
  return lights;
}

Lights load_lights(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  return load_lights(path, warnings);
}

void save_lights(const Lights& lights, const std::filesystem::path& path) {
  std::string text = "{\"lights\":[";
  for (std::size_t i = 0; i < lights.size(); ++i) text += (i == 0 ? "\n  " : ",\n  ") + dumped(lights[i], path);
  text += "\n]}\n";
  write_file_atomically(path, text);
}

}  // namespace chiaro::renderer
