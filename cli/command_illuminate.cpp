#include <memory>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/illumination_base.h"
#include "cli/program.h"
#include "cli/scene_loading.h"
#include "cli/text_output.h"
#include "cli/transport_options.h"
#include "inverse/target/target.h"

namespace chiaro::cli {
namespace {

struct IlluminateCommand {
  CommonOptions common;
  TransportOptions transport;
  SurfaceOptions surface;
  std::string scene, lights, output;
};

void print_summary(Session& session, const IlluminateCommand& options, const TracedTarget& traced) {
  const JsonObject summary{{"output", options.output},
                           {"receivers", traced.target.receivers.size()},
                           {"mean_illumination", mean_illumination(traced.target)},
                           {"relative_standard_error", traced.relative_standard_error},
                           {"samples", options.transport.samples},
                           {"seconds", session.seconds()}};
  session.finish(summary,
                 aligned_rows({{"receivers", fmt::format("{}", traced.target.receivers.size())},
                               {"mean illumination", text_of_vector(mean_illumination(traced.target)) + " cd/m²"},
                               {"relative standard error", text_of_percent(traced.relative_standard_error)},
                               {"time", text_of_seconds(session.seconds())},
                               {"written", options.output}}));
}

int run_illuminate(const IlluminateCommand& options) {
  Session session(options.common);
  session.require_outputs({options.output});
  const LoadedStage stage = load_stage(options.scene, options.transport.load, options.transport.materials, session);
  const renderer::Lights lights = choose_lights(stage, options.lights, options.transport.environment, session);
  require_light(stage, lights, "lights in the scene, or a light file given with --lights");
  inverse::Receivers receivers = choose_receivers(*stage.tracer, options.surface, session);
  const TracedTarget traced = trace_target(*stage.tracer, std::move(receivers), lights,
                                           trace_options(options.transport, options.common), session.control());
  if (is_black(traced.target)) session.warn(options.output + ": no light reaches any receiver");
  inverse::save_target(traced.target, options.output);
  print_summary(session, options, traced);
  return kDone;
}

}  // namespace

CommandRun add_illuminate(CLI::App& command) {
  const auto options = std::make_shared<IlluminateCommand>();
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_output(command, {"-o,--output", "T.glb", "The illumination, a target"}, options->output, {".glb", ".gltf"});
  add_input_file(command, {"--lights", "L", "Light file in place of the scene's lights"}, options->lights);
  add_surface_options(command, options->surface);
  add_transport_options(command, options->transport, "Paths per receiver");
  add_common_options(command, options->common);
  set_examples(command,
               "  chiaro illuminate room.glb -o lit.glb --lights lamps.json --samples 1024\n"
               "  chiaro illuminate room.glb -o direct.glb --bounces 0");
  return [options] { return run_illuminate(*options); };
}

}  // namespace chiaro::cli
