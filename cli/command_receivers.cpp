#include <memory>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/program.h"
#include "cli/scene_options.h"
#include "cli/session.h"
#include "cli/text_output.h"
#include "cli/transport_options.h"
#include "inverse/transport/receivers.h"
#include "renderer/io/load_gltf.h"

namespace chiaro::cli {
namespace {

struct ReceiversCommand {
  CommonOptions common;
  std::string scene, output;
  renderer::LoadOptions load;
  float max_edge = 0;
};

void print_summary(Session& session, const ReceiversCommand& options, const inverse::Receivers& receivers) {
  const JsonObject summary{{"output", options.output},
                           {"receivers", receivers.size()},
                           {"triangles", receivers.triangles.size()},
                           {"parts", receivers.parts.size()},
                           {"fingerprint", inverse::fingerprint(receivers)}};
  session.finish(summary, one_line(fmt::format("{}: {} receivers, {} triangles, {} parts", options.output,
                                               receivers.size(), receivers.triangles.size(), receivers.parts.size())) +
                              "\n");
}

int run_receivers(const ReceiversCommand& options) {
  Session session(options.common);
  session.require_outputs({options.output});
  const renderer::LoadedScene loaded = renderer::load_gltf(options.scene, options.load, session.control());
  session.warn(loaded.warnings);
  const inverse::Receivers receivers =
      inverse::make_receivers(loaded.scene, {.max_edge = options.max_edge}, session.control());
  session.stop_if_interrupted();
  renderer::save_vertex_mesh(inverse::mesh_from_receivers(receivers), options.output, 1);
  print_summary(session, options, receivers);
  return kDone;
}

}  // namespace

CommandRun add_receivers(CLI::App& command) {
  const auto options = std::make_shared<ReceiversCommand>();
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_output(command, {"-o,--output", "R.glb", "The receivers"}, options->output, {".glb", ".gltf"});
  add_max_edge_option(command, options->max_edge);
  add_scene_options(command, options->load);
  add_common_options(command, options->common);
  set_examples(command, "  chiaro receivers room.glb -o room_receivers.glb --max-edge 0.1");
  return [options] { return run_receivers(*options); };
}

}  // namespace chiaro::cli
