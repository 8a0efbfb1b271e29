#include "cli/solve_options.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/output_paths.h"
#include "cli/usage_error.h"
#include "renderer/core/error.h"
#include "renderer/io/light_file.h"

namespace chiaro::cli {
namespace {

inverse::SolveMethod parse_method(const std::string& text) {
  if (text == "thesis") return inverse::SolveMethod::kThesis;
  if (text == "joint") return inverse::SolveMethod::kJoint;
  throw UsageError(fmt::format("'{}' (expected thesis or joint)", text));
}

inverse::Objective parse_objective(const std::string& text) {
  if (text == "l2") return inverse::Objective::kL2;
  if (text == "relative") return inverse::Objective::kRelative;
  if (text == "perceptual") return inverse::Objective::kPerceptual;
  throw UsageError(fmt::format("'{}' (expected l2, relative or perceptual)", text));
}

void parse_importance_weights(const std::string& text, inverse::SolveOptions& solve) {
  const std::vector<double> weights = parse_numbers(text, 2, kNotNegative);
  constexpr double kMost = 1e9;
  if (weights[0] + weights[1] <= 0 || weights[0] > kMost || weights[1] > kMost) {
    throw UsageError(fmt::format("'{}' (expected one above 0, and none above {:g})", text, kMost));
  }
  solve.geometry_weight = weights[0];
  solve.illumination_weight = weights[1];
}

void add_method_options(CLI::App& command, inverse::SolveOptions& solve) {
  add_parsed(command, {"--method", "NAME", "joint, or thesis: the published pipeline, step for step (default joint)"},
             [&solve](const std::string& text) { solve.method = parse_method(text); });
  add_parsed(command,
             {"--objective", "NAME",
              "What the lights come closest in: l2, relative (to the target, place by place) or perceptual (lightness; "
              "default l2)"},
             [&solve](const std::string& text) { solve.objective = parse_objective(text); });
  add_number(command, {"--error-threshold", "E", "Of the lightcut, relative L2 (default: from the method)"},
             solve.error_threshold, kPositive);
  add_count(command,
            {"--important-vertices", "M", fmt::format("Receivers to solve on (default {})", solve.important_vertices)},
            solve.important_vertices, {1, 10'000'000});
  add_parsed(command, {"--importance-weights", "w1,w2", "Of geometry and illumination (default 1,1)"},
             [&solve](const std::string& text) { parse_importance_weights(text, solve); });
  add_number(command,
             {"--weak-light", "W",
              fmt::format("Part of the target below which the search drops a light of its grid (default {})",
                          solve.weak_light)},
             solve.weak_light, kZeroToOne);
  add_number(command,
             {"--time-limit", "SECONDS",
              "Stop searching then, with what is found; a last check of at least 16 paths per receiver and the bake "
              "come beside"},
             solve.time_limit, kPositive);
  add_count(command,
            {"--verification-samples", "N",
             "Paths per receiver of the final check, by which the lights settle (default: until their noise is that "
             "of the target, of up to seven lights twice that if no more than 3 %, or little beside what the lights "
             "leave; at most 16 to 1024, by the number of receivers). Below 256, and below 2 million in all, they stay "
             "where the search left them"},
            solve.verification_samples, {1, 1 << 24});
}

// What stays lit: the environment, and with --keep-lights the scene's other lights.
renderer::Lights lights_that_stay(const LoadedStage& stage, const SolveChoices& choices, Session& session) {
  const EnvironmentOptions environment = in_config(choices.transport.environment, choices.target.encoding.view.config);
  return choices.constraints.keep_lights ? choose_lights(stage, "", environment, session)
                                         : environment_of(stage, environment, session);
}

// With --keep-positions the scene's lights, but for environments. Error where there are none.
renderer::Lights lights_in_place(const LoadedStage& stage, const SolveChoices& choices) {
  if (!choices.constraints.keep_positions) return {};
  renderer::Lights lights = stage.lights;
  std::erase_if(lights, renderer::is_environment);
  if (!lights.empty()) return lights;
  throw renderer::Error({stage.scene->path, "lights", "there are none whose positions could be kept",
                         "lights in the scene, or no --keep-positions"});
}

}  // namespace

void settle_constraints(SolveChoices& choices) {
  choices.constraints = choose_constraints(choices.constraint_options, choices.grid);
  require_known_to(choices.solve.method, choices.constraints, choices.constraint_options);
  if (choices.solve.method == inverse::SolveMethod::kThesis && choices.solve.objective != inverse::Objective::kL2) {
    throw UsageError("--objective: --method thesis knows l2 alone (expected joint)");
  }
  choices.solve.max_lights = choices.constraints.max_lights.value_or(choices.solve.max_lights);
  choices.solve.exact_lights = choices.constraints.lights.value_or(0);
}

void add_solve_options(CLI::App& command, SolveChoices& choices) {
  add_target_options(command, choices.target);
  add_method_options(command, choices.solve);
  add_grid_options(command, choices.grid);
  add_constraint_options(command, choices.constraint_options);
  add_transport_options(command, choices.transport, "Gather rays per receiver of a bake");
}

inverse::SolveProblem solve_problem(const LoadedStage& stage, const inverse::Target& target,
                                    const SolveChoices& choices, const CommonOptions& common, Session& session) {
  inverse::SolveProblem problem{.tracer = *stage.tracer,
                                .target = target,
                                .cache_file = {},
                                .grid = {},
                                .bake = bake_settings(choices.transport, common),
                                .kept_lights = lights_that_stay(stage, choices, session),
                                .places = place_rules(*stage.scene, choices.constraints),
                                .intensities = intensity_rules(choices.constraints),
                                .lights_in_place = lights_in_place(stage, choices)};
  problem.grid = inverse::around_places({.counts = choices.grid.size.counts, .error = choices.grid.size.error},
                                        *stage.scene, problem.places);
  return problem;
}

inverse::SolveOptions solve_options(const SolveChoices& choices, const CommonOptions& common) {
  inverse::SolveOptions options = choices.solve;
  options.seed = common.seed;
  return options;
}

void warn_of_scene_lights(const LoadedStage& stage, const SolveChoices& choices, Session& session) {
  const auto own = stage.lights.size() -
                   std::size_t(std::count_if(stage.lights.begin(), stage.lights.end(), renderer::is_environment));
  if (own == 0 || choices.constraints.keep_lights || choices.constraints.keep_positions) return;
  session.warn(
      fmt::format("{}: its own lights ({}) are taken out; --keep-lights leaves them lit", stage.scene->path, own));
}

renderer::AddLightsOptions output_scene_options(const LoadedStage& stage, const SolveChoices& choices) {
  renderer::AddLightsOptions options{.keep_lights = choices.constraints.keep_lights,
                                     .external = choices.transport.load.external};
  if (choices.constraints.keep_positions) options.relit_nodes = stage.light_nodes;
  return options;
}

void save_found_lights(const LoadedStage& stage, const inverse::SolveResult& result, const std::string& output,
                       const renderer::AddLightsOptions& options) {
  renderer::Lights lights;
  for (const inverse::FoundLight& found : result.lights) lights.emplace_back(found.light);
  const std::filesystem::path alone = beside(output, ".json");
  renderer::save_lights(lights, alone);
  try {
    require_unchanged(stage);
    renderer::save_gltf_with_lights(stage.scene->path, lights, output, options);
  } catch (const renderer::Error& error) {
    const auto& [file, place, problem, expected] = error.parts();
    throw renderer::Error(
        {file, place, fmt::format("{}; the lights found are in {}", problem, alone.string()), expected});
  }
}

}  // namespace chiaro::cli
