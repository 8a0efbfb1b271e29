#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/output_paths.h"
#include "cli/program.h"
#include "cli/solve_options.h"
#include "cli/text_output.h"
#include "cli/usage_error.h"
#include "inverse/solve/error_curve_file.h"
#include "inverse/solve/report.h"
#include "renderer/core/error.h"

namespace chiaro::cli {
namespace {

struct SolveCommand {
  const CLI::App* command = nullptr;
  CommonOptions common;
  SolveChoices choices;
  std::string scene, cache, report, from, save_target, output;
};

// A cache knows how many bounces it holds; the final check traces as many unless told otherwise.
void use_cache(const SolveCommand& options, inverse::SolveProblem& problem) {
  if (options.cache.empty()) return;
  problem.cache_file = options.cache;
  const inverse::TransportCache header = inverse::load_transport_cache_header(options.cache);
  if (!options.choices.transport.bounces) problem.bake.bounces = header.settings.bounces;
}

void print_summary(Session& session, const SolveCommand& options, const WantedTarget& wanted,
                   const inverse::SolveResult& result) {
  JsonObject summary = solve_summary(result);
  summary.insert(summary.end(), wanted.pictures.begin(), wanted.pictures.end());
  std::string files = fmt::format("{}, {}", options.output, beside(options.output, ".json").string());
  for (const std::string& other : {options.save_target, options.report}) files += other.empty() ? "" : ", " + other;
  const std::string written = aligned_rows({{"written", files}});
  session.finish(summary, wanted.text + solve_text(result) + written);
}

void warn_of_idle_options(const SolveCommand& options, Session& session) {
  session.warn(idle_view_options(*options.command, {"--target-image", "--target-lightmap"}, {"--environment"}));
  session.warn(idle_target_options(*options.command));
  session.warn(idle_options(*options.command, {"--hide-backs"}, {"--target-image"}));
  if (!options.cache.empty() && was_given(*options.command, "--samples")) {
    session.warn("--samples: does nothing with --cache, which was baked with its own");
  }
  if (options.choices.constraints.keep_positions) {
    session.warn(given_for_nothing(
        *options.command,
        {"--grid", "--important-vertices", "--importance-weights", "--error-threshold", "--weak-light", "--samples"},
        "with --keep-positions"));
  }
}

void refuse_what_excludes_each_other(const SolveCommand& options) {
  const bool in_place = options.choices.constraints.keep_positions;
  if (in_place && !options.report.empty()) {
    throw UsageError("--report: solves with --keep-positions have no stages to report (expected no --report)");
  }
  if (in_place && !options.from.empty()) throw UsageError("--from and --keep-positions exclude each other");
  if (options.choices.solve.method == inverse::SolveMethod::kThesis && !options.from.empty()) {
    throw UsageError("--from: --method thesis begins from its bake alone (expected joint)");
  }
}

int run_solve(SolveCommand options) {
  Session session(options.common);
  require_a_target(options.choices.target);
  settle_constraints(options.choices);
  refuse_what_excludes_each_other(options);
  session.require_outputs({options.output, beside(options.output, ".json"), options.save_target});
  if (!options.report.empty()) session.require_outputs_in(options.report, inverse::report_files());
  require_copyable(options.scene, options.output);
  const LoadedStage stage =
      load_stage(options.scene, options.choices.transport.load, options.choices.transport.materials, session);
  warn_of_scene_lights(stage, options.choices, session);
  warn_of_idle_options(options, session);
  const WantedTarget wanted = load_wanted_target(stage, options.choices.target, session);
  session.stop_if_interrupted();
  inverse::SolveProblem problem = solve_problem(stage, wanted.target, options.choices, options.common, session);
  use_cache(options, problem);
  NewFolders folders;
  if (!options.report.empty()) folders.make(options.report);
  inverse::SolveOptions solving = solve_options(options.choices, options.common);
  solving.keep_stages = !options.report.empty();
  if (!options.from.empty()) {
    solving.earlier = inverse::load_error_curve(options.from);
    solving.earlier_file = options.from;
  }
  const inverse::SolveResult result = inverse::solve(problem, solving, session.control());
  session.stop_if_interrupted();
  save_found_lights(stage, result, options.output, output_scene_options(stage, options.choices));
  if (!options.save_target.empty()) inverse::save_target(wanted.target, options.save_target);
  if (!options.report.empty()) inverse::write_report(*stage.scene, wanted.target, result, options.report);
  print_summary(session, options, wanted, result);
  return kDone;
}

}  // namespace

CommandRun add_solve(CLI::App& command) {
  const auto options = std::make_shared<SolveCommand>();
  options->command = &command;
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_output(command,
             {"-o,--output", "LIGHTS.glb",
              "SCENE with the lights found in place of its own; LIGHTS.json, those found alone, beside it"},
             options->output, {".glb", ".gltf"});
  add_solve_options(command, options->choices);
  add_view_options(command, options->choices.target.encoding.view,
                   {"--exposure", "EV", "Exposure that painted pictures were made at, which is undone (default 0)"});
  add_hide_backs(command, options->choices.transport.materials);
  add_output(command, {"--save-target", "T.glb", "What the pictures and the target come to, as a target file"},
             options->save_target, {".glb", ".gltf"})
      ->required(false);
  add_input_file(command, {"--cache", "C.exr", "A transport cache; without one solve bakes by itself"}, options->cache);
  add_input_file(command,
                 {"--from", "SOLVE.json",
                  "The summary (--json) of another solve of this target: its lights are refined and no others looked "
                  "for, as for another --lights N"},
                 options->from);
  add_text(command, {"--report", "DIR", "Write what each stage found into this folder"}, options->report);
  add_common_options(command, options->common);
  command.get_option("--grid")->excludes("--cache");
  set_examples(
      command,
      "  chiaro solve room.glb --target painted.glb --cache room.exr -o lights.glb\n"
      "  chiaro solve room.glb --target painted.glb -o lights.glb --max-lights 5 --report report\n"
      "  chiaro solve room.glb --target-image Camera=painted.png --exposure 3 -o lights.glb\n"
      "  chiaro solve room.glb --target-lightmap Floor=floor.exr --target-lightmap Walls=walls.exr -o lights.glb\n"
      "  chiaro solve room.glb --target painted.glb -o three.glb --from solve.json --lights 3");
  return [options] { return run_solve(*options); };
}

}  // namespace chiaro::cli
