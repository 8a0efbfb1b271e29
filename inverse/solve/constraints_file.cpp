#include <fmt/format.h>

#include "inverse/solve/light_constraints.h"
#include "inverse/target/json_field.h"
#include "renderer/core/blackbody.h"

namespace chiaro::inverse {
namespace {

constexpr int kMostLights = 1000;

int read_count(const JsonField& field) {
  const char* const expected = "a whole number from 1 to 1000";
  if (!field.value.is_number_integer()) field.fail_as_found(expected);
  return int(read_double(field, {1, float(kMostLights)}, expected));
}

std::string read_name(const JsonField& field) {
  if (!field.value.is_string() || field.value.get_ref<const std::string&>().empty()) {
    field.fail_as_found("the name of a node");
  }
  return field.value.get<std::string>();
}

Mount read_mount(const JsonField& field) {
  static constexpr std::string_view kKnown[] = {"on", "clearance"};
  expect_object(field, kKnown, std::span(kKnown).first(1));
  Mount mount{read_name(field.member("on")), {}, {field.file, field.place}};
  if (field.has("clearance")) {
    mount.clearance = read_double(field.member("clearance"), kNotNegative, "a number ≥ 0, metres");
  }
  return mount;
}

std::string read_box(const JsonField& field) {
  const char* const expected = "a node's name, six numbers x0, y0, z0, x1, y1, z1 in metres, or {\"on\": node}";
  if (field.value.size() != 6) field.fail_as_found(expected);
  std::vector<float> numbers;
  for (std::size_t i = 0; i < 6; ++i) numbers.push_back(read_number(field.element(i), {}, "a finite number, metres"));
  return fmt::format("{}", fmt::join(numbers, ","));
}

void read_regions(const JsonField& field, LightConstraints& constraints) {
  if (!field.value.is_array() || field.value.empty()) field.fail_as_found("an array of regions");
  for (std::size_t i = 0; i < field.value.size(); ++i) {
    const JsonField region = field.element(i);
    if (region.value.is_object()) {
      constraints.mounts.push_back(read_mount(region));
    } else {
      const std::string text = region.value.is_array() ? read_box(region) : read_name(region);
      constraints.regions.push_back({text, {region.file, region.place}});
    }
  }
}

std::array<double, 2> read_kelvin(const JsonField& field) {
  const char* const expected = "two temperatures, the lower first, from 1667 to 25000 kelvin";
  if (!field.value.is_array() || field.value.size() != 2) field.fail_as_found(expected);
  constexpr JsonRange kKelvin{float(renderer::kLeastKelvin), float(renderer::kMostKelvin)};
  const std::array<double, 2> kelvin{read_double(field.element(0), kKelvin, expected),
                                     read_double(field.element(1), kKelvin, expected)};
  if (kelvin[0] > kelvin[1]) field.fail("the first is higher than the second", expected);
  return kelvin;
}

LightConstraints read_constraints(const JsonField& root) {
  static constexpr std::string_view kKnown[] = {"lights",         "max_lights",    "regions", "surface_distance",
                                                "light_distance", "max_intensity", "kelvin",  "one_color",
                                                "keep_lights",    "keep_positions"};
  expect_object(root, kKnown, {});
  LightConstraints c;
  const auto distance = [&](const char* name, std::optional<double>& value) {
    if (root.has(name)) value = read_double(root.member(name), kNotNegative, "a number ≥ 0, metres");
  };
  const auto flag = [&](const char* name, bool& value) {
    if (root.has(name)) value = read_bool(root.member(name));
  };
  if (root.has("lights")) c.lights = read_count(root.member("lights"));
  if (root.has("max_lights")) c.max_lights = read_count(root.member("max_lights"));
  if (root.has("regions")) read_regions(root.member("regions"), c);
  distance("surface_distance", c.surface_distance);
  distance("light_distance", c.light_distance);
  if (root.has("max_intensity")) {
    c.max_intensity = read_double(root.member("max_intensity"), kPositive, "a number > 0, candela");
  }
  if (root.has("kelvin")) c.kelvin = read_kelvin(root.member("kelvin"));
  flag("one_color", c.one_color);
  flag("keep_lights", c.keep_lights);
  flag("keep_positions", c.keep_positions);
  const auto contradiction = find_contradiction(c, std::identity{});
  if (contradiction) root.member(contradiction->key).fail(contradiction->reason, "one of the two");
  return c;
}

}  // namespace

LightConstraints load_constraints(const std::filesystem::path& path) {
  return read_json_file(path, "a file of constraints in JSON", read_constraints);
}

}  // namespace chiaro::inverse
