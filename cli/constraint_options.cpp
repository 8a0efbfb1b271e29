#include "cli/constraint_options.h"

#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/usage_error.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/blackbody.h"

namespace chiaro::cli {
namespace {

constexpr CountRange kLightCount{1, 1000};

std::array<double, 2> parse_kelvin(const std::string& text) {
  const std::vector<double> kelvin =
      parse_numbers(text, 2, {.min = renderer::kLeastKelvin, .max = renderer::kMostKelvin});
  if (kelvin[0] > kelvin[1]) throw UsageError(fmt::format("'{}' (expected the lower one first)", text));
  return {kelvin[0], kelvin[1]};
}

// "NODE", or "NODE,METRES"; a name may have commas in it.
inverse::Mount parse_mount(const std::string& text) {
  const std::size_t comma = text.rfind(',');
  if (text.empty() || comma == 0) throw UsageError(fmt::format("'{}' (expected NODE or NODE,METRES)", text));
  if (comma == text.npos) return {text};
  return {text.substr(0, comma), parse_number(std::string_view(text).substr(comma + 1), kNotNegative)};
}

std::string option_of(std::string key) {
  std::replace(key.begin(), key.end(), '_', '-');
  return "--" + key;
}

// The option, or the file and the key in it.
std::string name_as_given(const ConstraintOptions& options, const std::string& key) {
  const bool by_option = options.command != nullptr && was_given(*options.command, option_of(key));
  return by_option ? option_of(key) : fmt::format("{}: {}", options.file, key);
}

}  // namespace

void add_constraint_options(CLI::App& command, ConstraintOptions& options) {
  options.command = &command;
  inverse::LightConstraints& given = options.given;
  add_input_file(command,
                 {"--constraints", "FILE", "What follows here, and regions, as a JSON file; options come first"},
                 options.file);
  add_count(command, {"--max-lights", "N", "At most N lights (default 32)"}, given.max_lights, kLightCount);
  add_count(command, {"--lights", "N", "Exactly N lights"}, given.lights, kLightCount);
  add_repeated(
      command,
      {"--on-surface", "NODE[,M]",
       "Lights hang M metres in front of this node (default: a hundredth of the scene's diagonal); again for a "
       "further one"},
      [&given](const std::string& text) { given.mounts.push_back(parse_mount(text)); });
  add_number(command, {"--surface-distance", "M", "No light nearer than M metres to any surface"},
             given.surface_distance, kNotNegative);
  add_number(command, {"--light-distance", "M", "No two lights nearer than M metres to each other"},
             given.light_distance, kNotNegative);
  add_number(command, {"--max-intensity", "CD", "No channel of a light brighter than CD candela"}, given.max_intensity,
             kPositive);
  add_parsed(command, {"--kelvin", "FROM,TO", "Colours of black bodies, no colder and no hotter than these"},
             [&given](const std::string& text) { given.kelvin = parse_kelvin(text); });
  add_flag(command, "--one-color", given.one_color, "All lights have the same colour");
  add_flag(command, "--keep-lights", given.keep_lights, "Lights of SCENE stay lit and untouched");
  add_flag(command, "--keep-positions", given.keep_positions,
           "Lights of SCENE stay where they are, and their intensities alone are sought");
}

inverse::LightConstraints choose_constraints(const ConstraintOptions& options, const GridOptions& grid) {
  inverse::LightConstraints constraints = options.given;
  constraints.regions = grid.regions;
  if (!options.file.empty()) constraints = merged(constraints, inverse::load_constraints(options.file));
  const auto name = [&](const std::string& key) { return name_as_given(options, key); };
  if (const auto contradiction = find_contradiction(constraints, name)) throw UsageError(contradiction->reason);
  return constraints;
}

void require_known_to(inverse::SolveMethod method, const inverse::LightConstraints& constraints,
                      const ConstraintOptions& options) {
  if (method == inverse::SolveMethod::kJoint) return;
  const std::pair<const char*, bool> unknown[] = {{"light_distance", constraints.light_distance.has_value()},
                                                  {"max_intensity", constraints.max_intensity.has_value()},
                                                  {"kelvin", constraints.kelvin.has_value()},
                                                  {"one_color", constraints.one_color},
                                                  {"keep_positions", constraints.keep_positions}};
  for (const auto& [key, given] : unknown) {
    if (given) throw UsageError(name_as_given(options, key) + ": --method thesis does not know it (expected joint)");
  }
}

inverse::PlaceRules place_rules(const renderer::Scene& scene, const inverse::LightConstraints& constraints) {
  return {.boxes = boxes_of(scene, constraints.regions),
          .mounts = constraints.mounts,
          .surface_distance = constraints.surface_distance.value_or(0),
          .light_distance = constraints.light_distance.value_or(0)};
}

void require_a_place(const renderer::Scene& scene, const inverse::LightGrid& grid, const inverse::PlaceRules& rules,
                     const renderer::Control& control) {
  const inverse::AllowedPlaces places(scene, grid.region, rules);
  const auto is_near_one = [&](renderer::Vec3f light) {
    control.stop_if_requested();
    return places.nearest(inverse::to_eigen(light)).has_value();
  };
  if (std::any_of(grid.positions.begin(), grid.positions.end(), is_near_one)) return;
  throw inverse::no_place(scene, rules);
}

inverse::IntensityRules intensity_rules(const inverse::LightConstraints& constraints) {
  inverse::IntensityRules rules{.one_color = constraints.one_color, .kelvin = constraints.kelvin};
  if (constraints.max_intensity) rules.max_intensity = *constraints.max_intensity;
  return rules;
}

}  // namespace chiaro::cli
