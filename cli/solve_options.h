#pragma once
// What `solve` and `run` share.

#include <string>

#include "cli/json_output.h"
#include "cli/scene_loading.h"
#include "cli/transport_options.h"
#include "inverse/solve/solve.h"

namespace chiaro::cli {

struct SolveChoices {
  std::string target;
  float target_scale = 1;  // cd/m² per COLOR_0, where a target has no _ILLUMINATION
  bool keep_lights = false;
  GridOptions grid;
  TransportOptions transport;
  inverse::SolveOptions solve;
};

void add_solve_options(CLI::App& command, SolveChoices& choices);

inverse::Target load_solve_target(const LoadedStage& stage, const SolveChoices& choices);

// What stays lit: the environment, and with --keep-lights the scene's other lights.
renderer::Lights lights_that_stay(const LoadedStage& stage, const SolveChoices& choices, Session& session);

// The problem without a cache file and without lights that stay. It refers to the stage and the target.
inverse::SolveProblem solve_problem(const LoadedStage& stage, const inverse::Target& target,
                                    const SolveChoices& choices, const CommonOptions& common);

inverse::SolveOptions solve_options(const SolveChoices& choices, const CommonOptions& common);

// Passes on what a user should know of the result before believing it.
void warn_of_scene_lights(const LoadedStage& stage, const SolveChoices& choices, Session& session);

// LIGHTS.glb, the scene with the lights found, and LIGHTS.json beside it, the lights alone.
void save_found_lights(const std::string& scene, const inverse::SolveResult& result, const std::string& output,
                       bool keep_lights);

JsonObject solve_summary(const inverse::SolveResult& result);
std::string solve_text(const inverse::SolveResult& result);

}  // namespace chiaro::cli
