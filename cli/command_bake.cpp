#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/bake_summary.h"
#include "cli/commands.h"
#include "cli/output_paths.h"
#include "cli/program.h"
#include "cli/scene_loading.h"
#include "cli/text_output.h"
#include "cli/transport_options.h"
#include "inverse/transport/bake.h"

namespace chiaro::cli {
namespace {

struct BakeCommand {
  CommonOptions common;
  TransportOptions transport;
  SurfaceOptions surface;
  GridOptions grid;
  std::string scene, output;
};

void print_summary(Session& session, const BakeCommand& options, const inverse::BakeResult& result) {
  const inverse::TransportCache& cache = result.cache;
  JsonObject summary{{"output", options.output}};
  for (auto& figure : bake_summary(result)) summary.push_back(std::move(figure));
  summary.emplace_back("seconds", session.seconds());
  session.finish(
      summary,
      aligned_rows({{"receivers", fmt::format("{}", cache.receiver_count)},
                    {"lights", fmt::format("{} on a grid of {} x {} x {}", cache.grid.positions.size(),
                                           cache.grid.counts[0], cache.grid.counts[1], cache.grid.counts[2])},
                    {"spacing", text_of_vector(cache.grid.spacing) + " m"},
                    {"error of indirect light", text_of_percent(cache.indirect_relative_error)},
                    {"direct", text_of_seconds(result.summary.direct_seconds)},
                    {"indirect", text_of_seconds(result.summary.indirect_seconds)},
                    {"check", text_of_seconds(result.summary.check_seconds)},
                    {"time", text_of_seconds(session.seconds())},
                    {"written", fmt::format("{}, {}", options.output,
                                            text_of_bytes(double(std::filesystem::file_size(options.output))))}}));
}

int run_bake(const BakeCommand& options) {
  Session session(options.common);
  require_writable(options.output);
  const LoadedStage stage = load_stage(options.scene, options.transport.load, options.transport.materials, session);
  environment_of(stage, options.transport.environment, session);  // refused where a solve would refuse it
  const inverse::Receivers receivers = choose_receivers(*stage.tracer, options.surface);
  const inverse::LightGrid grid =
      inverse::make_light_grid(*stage.tracer, light_grid_options(*stage.scene, options.grid));
  session.stop_if_interrupted();
  require_memory_for_bake(options.scene, receivers, grid);
  const inverse::BakeResult result = inverse::bake(*stage.tracer, receivers, grid,
                                                   bake_settings(options.transport, options.common), session.control());
  inverse::save_transport_cache(result.cache, options.output);
  print_summary(session, options, result);
  return kDone;
}

}  // namespace

CommandRun add_bake(CLI::App& command) {
  const auto options = std::make_shared<BakeCommand>();
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_output(command, {"-o,--output", "C.exr", "The transport cache"}, options->output, {".exr"});
  add_surface_options(command, options->surface);
  add_grid_options(command, options->grid);
  add_transport_options(command, options->transport, "Gather rays per receiver");
  add_common_options(command, options->common);
  set_examples(command,
               "  chiaro bake room.glb -o room.exr --on painted.glb --grid 12,8,12\n"
               "  chiaro bake room.glb -o room.exr --region Ceiling --bounces 2");
  return [options] { return run_bake(*options); };
}

}  // namespace chiaro::cli
