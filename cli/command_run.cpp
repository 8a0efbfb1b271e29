#include <filesystem>
#include <memory>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/bake_summary.h"
#include "cli/command_text.h"
#include "cli/commands.h"
#include "cli/comparison_summary.h"
#include "cli/frame_output.h"
#include "cli/memory.h"
#include "cli/output_paths.h"
#include "cli/program.h"
#include "cli/run_pictures.h"
#include "cli/solve_options.h"
#include "cli/text_output.h"
#include "inverse/transport/bake_file.h"
#include "inverse/transport/grid_by_error.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/file_lock.h"

namespace chiaro::cli {
namespace {

constexpr int kDefaultFrameSamples = 64;
constexpr const char* kLightsFile = "lights.glb";
constexpr const char* kCacheFile = "cache.exr";

struct RunCommand {
  CommonOptions common;
  SolveChoices choices;
  FrameOptions frame;
  int frame_samples = kDefaultFrameSamples;
  std::string scene, output;
  const CLI::App* command = nullptr;

  std::filesystem::path folder() const { return output; }
};

// The cache lives in its file alone from here on.
JsonObject bake_cache(const RunCommand& options, const LoadedStage& stage, const inverse::Target& target,
                      const inverse::SolveProblem& problem, Session& session) {
  const inverse::LightGrid grid =
      inverse::choose_light_grid(*stage.tracer, target.receivers, problem.grid, problem.bake, session.control());
  require_a_place(*stage.scene, grid, problem.places, session.control());
  inverse::Baker baker(*stage.tracer, target.receivers, grid, problem.bake, memory_left({}), session.control());
  const inverse::BakeSummary summary =
      inverse::bake_to_file(baker, options.folder() / kCacheFile, {.keeps_unfinished = false}, session.control());
  return bake_summary(baker.header(), summary);
}

renderer::Lights lights_of(const inverse::SolveResult& result, const inverse::SolveProblem& problem) {
  renderer::Lights lights = problem.kept_lights;
  for (const inverse::FoundLight& found : result.lights) lights.emplace_back(found.light);
  return lights;
}

// Two cameras may have one name, or names that differ in what a file name cannot hold.
class UnusedNames {
 public:
  std::string unused(const std::string& name) {
    const std::string base = file_name_of(name);
    std::string candidate = base;
    for (int& last = last_.try_emplace(base, 1).first->second; !used_.insert(candidate).second;) {
      candidate = fmt::format("{}-{}", base, ++last);
    }
    return candidate;
  }

 private:
  std::unordered_set<std::string> used_;
  std::unordered_map<std::string, int> last_;  // number given to a name
};

struct NamedCamera {
  renderer::Camera camera;
  std::string file_name;  // without extension
};

std::vector<NamedCamera> cameras_of(const RunCommand& options, const LoadedStage& stage, Session& session) {
  std::vector<renderer::Camera> cameras = stage.scene->cameras;
  if (cameras.empty()) cameras = {choose_camera(*stage.scene, "", options.frame.size, session)};
  std::vector<NamedCamera> named;
  UnusedNames names;
  for (renderer::Camera& camera : cameras) {
    const std::string name = names.unused(camera.name);
    named.push_back({std::move(camera), name});
  }
  return named;
}

renderer::Frame render_camera(const RunCommand& options, const LoadedStage& stage, const renderer::Camera& camera,
                              const renderer::Lights& lights, const std::filesystem::path& file, Session& session) {
  TransportOptions transport = options.choices.transport;
  transport.samples = options.frame_samples;
  renderer::Frame frame = render_frame(*stage.tracer, camera, lights, options.frame,
                                       {trace_options(transport, options.common), session.control()});
  if (frame.interrupted) throw renderer::Interruption();
  const FrameOrigin origin = frame_origin({options.scene, kLightsFile, lights}, transport, options.common);
  const HalfLosses lost = save_frame(frame, camera, beside(file, ".exr"), origin, options.frame);
  warn_of_frame(frame, lost, camera.name, session);
  save_preview(frame.image, beside(file, ".png"), options.frame);
  return frame;
}

struct RenderedCameras {
  JsonList summaries;
  std::vector<PageCamera> pages;
};

RenderedCameras render_cameras(const RunCommand& options, const std::vector<NamedCamera>& cameras,
                               const LoadedStage& stage, const renderer::Lights& lights, const RunPictures& pictures,
                               Session& session) {
  RenderedCameras rendered;
  for (const auto& [camera, name] : cameras) {
    const renderer::Frame frame =
        render_camera(options, stage, camera, lights, options.folder() / "frames" / (name + ".exr"), session);
    JsonObject summary = frame_summary(frame, camera.name);
    summary.emplace(summary.begin(), "file", "frames/" + name + ".exr");
    rendered.summaries.emplace_back(std::move(summary));
    rendered.pages.push_back(make_page_camera(pictures, camera, name, frame.image, session.control()));
  }
  return rendered;
}

// What the lights found give, beside the target on the same receivers.
inverse::Target found_target(const inverse::Target& target, const inverse::SolveResult& result) {
  inverse::Target found = target;
  found.illumination = result.illumination;
  found.standard_error.clear();
  return found;
}

void print_summary(Session& session, const RunCommand& options, const std::string& text, const JsonObject& summary,
                   std::size_t frames) {
  renderer::write_file_atomically(options.folder() / "summary.json", json_text(without_seconds(summary)));
  session.finish(summary, text + aligned_rows({{"frames", fmt::format("{}", frames)},
                                               {"time", text_of_seconds(session.seconds())},
                                               {"written", options.output},
                                               {"page", (options.folder() / "index.html").string()}}));
}

std::string text_of_view(const ViewChoice& choice) {
  const auto or_default = [](const std::string& name) { return name.empty() ? "default" : name; };
  const std::string exposure = choice.auto_exposure ? "auto" : fmt::format("{:+g} EV", choice.view.exposure);
  return fmt::format("display {}, view {}, exposure {}", or_default(choice.view.display), or_default(choice.view.view),
                     exposure);
}

std::vector<TextRow> settings_of(const RunCommand& options, const LoadedStage& stage, const inverse::Target& target) {
  const TransportOptions& transport = options.choices.transport;
  return {{"seed", fmt::format("{}", options.common.seed)},
          {"materials", text_of_materials(transport.materials)},
          {"bounces", transport.bounces ? fmt::format("{}", *transport.bounces) : "until they no longer matter"},
          {"samples of the bake", fmt::format("{}", transport.samples)},
          {"paths per pixel", fmt::format("{}", options.frame_samples)},
          {"pictures", text_of_view(options.frame.view)},
          {"receivers", fmt::format("{}", target.receivers.size())},
          {"fingerprint of the scene", renderer::fingerprint(*stage.scene)},
          {"fingerprint of the receivers", inverse::fingerprint(target.receivers)}};
}

std::string text_of_wanted(const TargetChoices& choices) {
  std::vector<std::string> sources;
  if (!choices.file.empty()) sources.push_back(choices.file);
  for (const NamedFile& image : choices.images) sources.push_back(image.file);
  for (const NamedFile& lightmap : choices.lightmaps) sources.push_back(lightmap.file);
  return fmt::format("The lights that bring it closest to {}", fmt::join(sources, ", "));
}

void make_folders(const RunCommand& options, NewFolders& folders) {
  folders.make(options.folder());
  folders.make(options.folder() / "frames");
  folders.make(options.folder() / "pictures");
}

// A target file that is wanted as it is may well be that of an earlier run.
std::vector<std::string> output_files(const RunCommand& options) {
  std::vector<std::string> files{kLightsFile, "lights.json", "found.glb", "summary.json", "index.html"};
  for (const std::filesystem::path& file : inverse::files_of_bake(kCacheFile)) files.push_back(file.string());
  if (!is_target_file_alone(options.choices.target)) files.emplace_back("target.glb");
  return files;
}

std::vector<std::string> picture_files(const std::vector<NamedCamera>& cameras) {
  std::vector<std::string> files;
  for (const NamedCamera& camera : cameras) {
    for (const char* extension : {".exr", ".png"}) files.push_back("frames/" + camera.file_name + extension);
    for (const std::string& name : run_picture_files(camera.file_name)) files.push_back("pictures/" + name);
  }
  return files;
}

int run_run(RunCommand options) {
  Session session(options.common);
  options.choices.target.encoding.view = options.frame.view;
  require_a_target(options.choices.target);
  settle_constraints(options.choices);
  session.require_outputs_in(options.folder(), output_files(options));
  require_color_choices(options.frame, true);
  require_copyable(options.scene, options.folder() / kLightsFile);
  const LoadedStage stage =
      load_stage(options.scene, options.choices.transport.load, options.choices.transport.materials, session);
  const std::vector<NamedCamera> cameras = cameras_of(options, stage, session);
  for (const NamedCamera& named : cameras) require_frame(named.camera, options.frame);
  session.require_outputs_in(options.folder(), picture_files(cameras));
  warn_of_scene_lights(stage, options.choices, session);
  session.warn(idle_target_options(*options.command));
  session.warn(idle_frame_options(*options.command, options.choices.transport.bounces));
  const WantedTarget wanted = load_wanted_target(stage, options.choices.target, session);
  const inverse::Target& target = wanted.target;
  inverse::SolveProblem problem = solve_problem(stage, target, options.choices, options.common, session);
  NewFolders folders;
  make_folders(options, folders);
  const auto lock = renderer::FileLock::of_folder(options.folder());  // two runs would mix what they find
  JsonObject summary = wanted.pictures;
  if (problem.lights_in_place.empty()) {
    summary.emplace_back("bake", bake_cache(options, stage, target, problem, session));
    problem.cache_file = options.folder() / kCacheFile;
  }
  const inverse::SolveResult result =
      inverse::solve(problem, solve_options(options.choices, options.common), session.control());
  save_found_lights(stage, result, options.folder() / kLightsFile, output_scene_options(stage, options.choices));
  if (!is_target_file_alone(options.choices.target)) inverse::save_target(target, options.folder() / "target.glb");
  const inverse::Target found = found_target(target, result);
  inverse::save_target(found, options.folder() / "found.glb");
  const inverse::TargetComparison comparison = inverse::compare_targets(found, target);
  const RenderedCameras rendered =
      render_cameras(options, cameras, stage, lights_of(result, problem),
                     {*stage.tracer, target, found, options.frame, options.folder() / "pictures"}, session);
  summary.emplace_back("solve", solve_summary(result));
  summary.emplace_back("comparison", comparison_summary(comparison, target.receivers.positions[comparison.max_at]));
  summary.emplace_back("frames", rendered.summaries);
  summary.emplace_back("seconds", session.seconds());
  const RunPage page{.scene = std::filesystem::path(options.scene).filename().string(),
                     .wanted = text_of_wanted(options.choices.target),
                     .result = result,
                     .comparison = comparison,
                     .kept_lights = problem.kept_lights,
                     .cameras = rendered.pages,
                     .settings = settings_of(options, stage, target),
                     .command = command_text(*options.command, "again"),
                     .time_limited = options.choices.solve.time_limit > 0 || options.frame.time_limit > 0,
                     .summary = summary};
  renderer::write_file_atomically(options.folder() / "index.html", make_run_page(page));
  print_summary(session, options, wanted.text + solve_text(result), summary, rendered.pages.size());
  return kDone;
}

}  // namespace

CommandRun add_run(CLI::App& command) {
  const auto options = std::make_shared<RunCommand>();
  options->command = &command;
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_text(command, {"-o,--output", "DIR", "Folder for all results; made where it is missing"}, options->output)
      ->required();
  add_solve_options(command, options->choices);
  add_count(command, {"--frame-samples", "N", fmt::format("Paths per pixel (default {})", options->frame_samples)},
            options->frame_samples, {1, 1 << 24});
  add_frame_options(command, options->frame, "--frame-samples");
  add_hide_backs(command, options->choices.transport.materials);
  add_common_options(command, options->common);
  set_examples(command, "  chiaro run room.glb --target painted.glb -o room_lit --max-lights 5 --width 1280");
  return [options] { return run_run(*options); };
}

}  // namespace chiaro::cli
