#pragma once
// What `solve` and `run` share.

#include <string>

#include "cli/constraint_options.h"
#include "cli/json_output.h"
#include "cli/scene_loading.h"
#include "cli/target_options.h"
#include "cli/transport_options.h"
#include "inverse/solve/solve.h"
#include "renderer/io/save_gltf.h"

namespace chiaro::cli {

struct SolveChoices {
  TargetChoices target;
  ConstraintOptions constraint_options;
  GridOptions grid;
  TransportOptions transport;
  inverse::SolveOptions solve;
  inverse::LightConstraints constraints;  // settled
};

void add_solve_options(CLI::App& command, SolveChoices& choices);

// Fills in the constraints, from options and file. UsageError or Error where they are wrong.
void settle_constraints(SolveChoices& choices);

// The problem without a cache file. It refers to the stage and the target.
inverse::SolveProblem solve_problem(const LoadedStage& stage, const inverse::Target& target,
                                    const SolveChoices& choices, const CommonOptions& common, Session& session);

inverse::SolveOptions solve_options(const SolveChoices& choices, const CommonOptions& common);

// Passes on what a user should know of the result before believing it.
void warn_of_scene_lights(const LoadedStage& stage, const SolveChoices& choices, Session& session);

// How the scene with the lights found is made of the scene.
renderer::AddLightsOptions output_scene_options(const LoadedStage& stage, const SolveChoices& choices);

// LIGHTS.json, the lights alone, and then LIGHTS.glb, the scene with them, which more can keep from being written: an
// Error of that says where the lights are. One is also that the scene's files are others than were loaded.
void save_found_lights(const LoadedStage& stage, const inverse::SolveResult& result, const std::string& output,
                       const renderer::AddLightsOptions& options);

JsonObject solve_summary(const inverse::SolveResult& result);
std::string solve_text(const inverse::SolveResult& result);

std::string text_of_list(const std::vector<int>& numbers);  // "1, 2 and 5"
// "back wall near 1.2 0.8 -3 m is 62 % too dark (41 % of the error)"
std::string text_of_place(const inverse::NotReached& place);

}  // namespace chiaro::cli
