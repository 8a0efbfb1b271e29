#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/frame_output.h"
#include "cli/output_paths.h"
#include "cli/program.h"
#include "cli/scene_loading.h"
#include "cli/text_output.h"
#include "cli/transport_options.h"

namespace chiaro::cli {
namespace {

constexpr int kDefaultSamples = 64;
constexpr int kUntilClean = 1 << 14, kUntilTimeIsUp = 1 << 20;  // in place of them

struct RenderCommand {
  CommonOptions common;
  TransportOptions transport{.materials = {}, .load = {}, .samples = kDefaultSamples, .bounces = {}};
  FrameOptions frame;
  std::string scene, lights, camera, output;
  bool preview = false;
  const CLI::App* command = nullptr;
};

std::filesystem::path preview_of(const RenderCommand& options) {
  return options.preview ? beside(options.output, ".png") : "";
}

// Unlit surfaces are seen without light.
void warn_of_darkness(const LoadedStage& stage, const renderer::Lights& lights, Session& session) {
  if (!lights.empty() || renderer::has_emission(*stage.scene)) return;
  const auto draws = [&](bool unlit) {
    return renderer::any_drawn_material(*stage.scene, [&](const auto& material) { return material.unlit == unlit; });
  };
  if (!draws(false)) return;
  const char* const black = draws(true) ? "all but unlit surfaces is black" : "the frame is black";
  session.warn(fmt::format("{}: no light: {}", stage.scene->path, black));
}

// The header of the frame has --shutter and --iso all the same.
void warn_of_idle_options(const RenderCommand& options, Session& session) {
  session.warn(idle_view_options(*options.command, {"--preview"}, {"--output-space", "--environment", "--lights"}));
  session.warn(idle_frame_options(*options.command, options.transport.bounces));
  if (options.frame.lens.shutter && !options.preview) session.warn("--shutter: exposes nothing without --preview");
}

HalfLosses save_outputs(const RenderCommand& options, const renderer::Camera& camera, const renderer::Lights& lights,
                        const renderer::Frame& frame) {
  const FrameOrigin origin = frame_origin({options.scene, options.lights, lights}, options.transport, options.common);
  const HalfLosses lost = save_frame(frame, camera, options.output, origin, options.frame);
  if (options.preview) save_preview(frame.image, preview_of(options), options.frame);
  return lost;
}

std::string text_of_samples(const renderer::Frame& frame) {
  const std::string most = fmt::format("{} per pixel", frame.samples);
  if (frame.mean_samples == frame.samples) return most;
  return fmt::format("{:.1f} per pixel, {} at most", frame.mean_samples, frame.samples);
}

std::vector<std::string> written_files(const RenderCommand& options) {
  std::vector<std::string> files{options.output};
  if (options.preview) files.push_back(preview_of(options).string());
  return files;
}

void print_summary(Session& session, const RenderCommand& options, const renderer::Camera& camera,
                   const renderer::Frame& frame) {
  const std::vector<std::string> written = written_files(options);
  JsonObject summary{{"output", options.output}};
  if (options.preview) summary.emplace_back("preview", preview_of(options).string());
  for (auto& figure : frame_summary(frame, camera.name)) summary.push_back(std::move(figure));
  summary.emplace_back("written", json_list(written));
  session.finish(summary, aligned_rows({{"camera", camera.name},
                                        {"size", fmt::format("{} x {} pixels", frame.image.width, frame.image.height)},
                                        {"samples", text_of_samples(frame)},
                                        {"relative standard error", text_of_percent(frame.relative_standard_error)},
                                        {"time", text_of_seconds(frame.seconds)},
                                        {"written", fmt::format("{}", fmt::join(written, ", "))}}));
}

// In one line, as every command that is interrupted.
int interrupted_with(const std::string& output) {
  print_message(fmt::format("interrupted: {} has the samples so far", output));
  return kInterrupted;
}

// As many as it takes, where the user says when it ends and not by how many.
TransportOptions transport_of(const RenderCommand& options) {
  TransportOptions transport = options.transport;
  if (options.command->count("--samples") > 0) return transport;
  if (options.frame.time_limit > 0) transport.samples = kUntilTimeIsUp;
  if (options.frame.noise_threshold > 0) transport.samples = kUntilClean;
  return transport;
}

int run_render(const RenderCommand& options) {
  Session session(options.common);
  session.require_outputs({options.output, preview_of(options)});
  require_color_choices(options.frame, options.preview);
  const LoadedStage stage = load_stage(options.scene, options.transport.load, options.transport.materials, session);
  const renderer::Lights lights = choose_lights(
      stage, options.lights, in_config(options.transport.environment, options.frame.view.config), session);
  warn_of_darkness(stage, lights, session);
  warn_of_idle_options(options, session);
  const renderer::Camera camera = choose_camera(*stage.scene, options.camera, options.frame.size, session);
  const renderer::Frame frame = render_frame(*stage.tracer, camera, lights, options.frame,
                                             {trace_options(transport_of(options), options.common), session.control()});
  const HalfLosses lost = save_outputs(options, camera, lights, frame);
  warn_of_frame(frame, lost, options.output, session);
  print_summary(session, options, camera, frame);
  return frame.interrupted ? interrupted_with(options.output) : kDone;
}

}  // namespace

CommandRun add_render(CLI::App& command) {
  const auto options = std::make_shared<RenderCommand>();
  options->command = &command;
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_output(command, {"-o,--output", "F.exr", "The frame"}, options->output, {".exr"});
  add_input_file(command, {"--lights", "L", "Light file in place of the scene's lights"}, options->lights);
  add_text(command, {"--camera", "NAME", "Camera (default: the first)"}, options->camera);
  add_number(command,
             {"--time", "SECONDS",
              "Render for so long, but four samples of every pixel at least; --samples, if given, is then the most"},
             options->frame.time_limit, kPositiveFloat);
  add_flag(command, "--preview", options->preview, "Write F.png beside the frame, through OpenColorIO");
  add_frame_options(command, options->frame, fmt::format("--samples, {} by default,", kUntilClean));
  add_hide_backs(command, options->transport.materials);
  add_transport_options(command, options->transport, "Paths per pixel");
  add_common_options(command, options->common);
  set_examples(command,
               "  chiaro render lights.glb -o room.exr --width 1920 --samples 256 --preview\n"
               "  chiaro render room.glb --lights lamps.json --camera Door -o door.exr --layers albedo,lights");
  return [options] { return run_render(*options); };
}

}  // namespace chiaro::cli
