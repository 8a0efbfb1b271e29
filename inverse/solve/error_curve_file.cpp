#include "inverse/solve/error_curve_file.h"

#include <fmt/format.h>

#include "inverse/target/json_field.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

// A summary holds much else, which another version may call otherwise.
JsonField required(const JsonField& field, const std::string& name) {
  if (!field.value.is_object()) field.fail_as_found("an object");
  if (!field.has(name)) field.fail("has no \"" + name + "\"", "the summary of a solve, by --json");
  return field.member(name);
}

JsonField required_list(const JsonField& field, const std::string& name) {
  const JsonField list = required(field, name);
  if (!list.value.is_array() || list.value.empty()) list.fail_as_found("a list that is not empty");
  return list;
}

renderer::PointLight read_light(const JsonField& field) {
  renderer::PointLight light;
  const JsonField position = required(field, "position");
  light.position = read_triple(position, {}, "three finite numbers, metres");
  if (!renderer::in_world(light.position)) {
    position.fail("is too far away", fmt::format("a place within {:g} m of the origin", renderer::kWorldLimit));
  }
  light.intensity = read_triple(required(field, "intensity"), kNotNegative, "three numbers ≥ 0, candela");
  return light;
}

LightSet read_set(const JsonField& field) {
  LightSet set;
  const JsonField lights = required_list(field, "lights");
  for (std::size_t j = 0; j < lights.value.size(); ++j) set.lights.push_back(read_light(lights.element(j)));
  if (field.has("relative_l2")) {
    set.relative_l2 = double(read_number(field.member("relative_l2"), kNotNegative, "a number ≥ 0"));
  }
  return set;
}

// The summary of a run has that of its solve in it.
std::vector<LightSet> read_curve(const JsonField& root) {
  const JsonField curve = required(root.has("solve") ? root.member("solve") : root, "error_curve");
  if (curve.value.is_array() && curve.value.empty()) {
    curve.fail("has no sets of lights", "the summary of a solve with --method joint, which finds one of every size");
  }
  if (!curve.value.is_array()) curve.fail_as_found("a list of sets of lights");
  std::vector<LightSet> sets;
  for (std::size_t k = 0; k < curve.value.size(); ++k) sets.push_back(read_set(curve.element(k)));
  return sets;
}

}  // namespace

std::vector<LightSet> load_error_curve(const std::filesystem::path& path) {
  return read_json_file(path, "the summary of a solve in JSON", read_curve);
}

}  // namespace chiaro::inverse
