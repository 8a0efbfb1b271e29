#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/bake_summary.h"
#include "cli/commands.h"
#include "cli/error_context.h"
#include "cli/memory.h"
#include "cli/program.h"
#include "cli/scene_loading.h"
#include "cli/text_output.h"
#include "cli/transport_options.h"
#include "cli/usage_error.h"
#include "inverse/transport/bake_file.h"
#include "inverse/transport/grid_by_error.h"
#include "renderer/core/error.h"

namespace chiaro::cli {
namespace {

// "2/8"
inverse::Shard parse_shard(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  constexpr int kMostShards = 1'000'000;
  try {
    const int count = parse_count(text.substr(std::min(slash + 1, text.size())), {1, kMostShards});
    const int index = parse_count(text.substr(0, slash), {1, count});
    return {std::size_t(index) - 1, std::size_t(count)};
  } catch (const UsageError&) {
    throw UsageError(fmt::format("'{}' (expected I/N, with I from 1 to N)", text));
  }
}

struct BakeCommand {
  CommonOptions common;
  TransportOptions transport;
  SurfaceOptions surface;
  GridOptions grid;
  inverse::BakeFileOptions file;
  std::optional<double> memory;  // bytes
  std::string scene, output;
  const CLI::App* command = nullptr;
};

void print_summary(Session& session, const BakeCommand& options, const inverse::TransportCache& cache,
                   const inverse::BakeSummary& baked) {
  JsonObject summary{{"output", options.output}};
  for (auto& figure : bake_summary(cache, baked)) summary.push_back(std::move(figure));
  if (options.file.shard.count > 1) {
    summary.emplace_back("shard", fmt::format("{}/{}", options.file.shard.index + 1, options.file.shard.count));
  }
  summary.emplace_back("seconds", session.seconds());
  session.finish(
      summary,
      aligned_rows({{"receivers", fmt::format("{}", cache.receiver_count)},
                    {"lights", text_of_lights(cache.grid)},
                    {"spacing", text_of_vector(cache.grid.spacing) + " m"},
                    {"error of indirect light", text_of_percent(cache.indirect_relative_error)},
                    {"direct", text_of_seconds(baked.direct_seconds)},
                    {"indirect", text_of_seconds(baked.indirect_seconds)},
                    {"check", text_of_seconds(baked.check_seconds)},
                    {"write", text_of_seconds(baked.write_seconds)},
                    {"time", text_of_seconds(session.seconds())},
                    {"written", fmt::format("{}, {}", options.output,
                                            text_of_bytes(double(std::filesystem::file_size(options.output))))}}));
}

inverse::BakeSummary bake_saying_what_stays(const BakeCommand& options, inverse::Baker& baker, Session& session) {
  try {
    return naming_file(options.scene,
                       [&] { return inverse::bake_to_file(baker, options.output, options.file, session.control()); });
  } catch (const renderer::Interruption&) {
    throw renderer::Interruption(fmt::format("what is done stays in {}, --resume goes on from there",
                                             inverse::unfinished_bake(options.output).string()));
  }
}

// A cache is of unity lights alone.
void warn_of_idle_options(const BakeCommand& options, Session& session) {
  session.warn(given_for_nothing(*options.command,
                                 {"--environment", "--environment-rotation", "--environment-intensity"},
                                 "in a bake, which is the same under any environment"));
}

int run_bake(const BakeCommand& options) {
  Session session(options.common);
  session.require_outputs(inverse::files_of_bake(options.output));
  const LoadedStage stage = load_stage(options.scene, options.transport.load, options.transport.materials, session);
  environment_of(stage, options.transport.environment, session);  // refused where a solve would refuse it
  warn_of_idle_options(options, session);
  const inverse::Receivers receivers = choose_receivers(*stage.tracer, options.surface, session);
  const inverse::BakeSettings settings = bake_settings(options.transport, options.common);
  const inverse::LightGrid grid = inverse::choose_light_grid(
      *stage.tracer, receivers, light_grid_options(*stage.scene, options.grid), settings, session.control());
  session.stop_if_interrupted();
  inverse::Baker baker(*stage.tracer, receivers, grid, settings, memory_left(options.memory), session.control());
  const inverse::BakeSummary baked = bake_saying_what_stays(options, baker, session);
  print_summary(session, options, baker.header(), baked);
  return kDone;
}

}  // namespace

CommandRun add_bake(CLI::App& command) {
  const auto options = std::make_shared<BakeCommand>();
  options->command = &command;
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_output(command, {"-o,--output", "C.exr", "The transport cache"}, options->output, {".exr"});
  add_surface_options(command, options->surface);
  add_grid_options(command, options->grid);
  add_transport_options(command, options->transport, "Gather rays per receiver");
  add_parsed(command, {"--shard", "I/N", "Bake part I of N, for `chiaro merge`; 1/N is the first"},
             [options](const std::string& text) { options->file.shard = parse_shard(text); });
  add_flag(command, "--resume", options->file.resume,
           "Go on with a bake that was interrupted or killed, if there is one");
  add_parsed(
      command,
      {"--memory", "SIZE", "Take up so much memory at most: 800M, 4G (default: 3/4 of this machine's or container's)"},
      [options](const std::string& text) { options->memory = parse_bytes(text); });
  add_common_options(command, options->common);
  set_examples(command,
               "  chiaro bake room.glb -o room.exr --on painted.glb --grid 12,8,12\n"
               "  chiaro bake room.glb -o room.exr --region 0.2,1.8,0.2,3.8,2.4,2.8 --bounces 2\n"
               "  chiaro bake room.glb -o part2.exr --shard 2/8 --resume --memory 4G");
  return [options] { return run_bake(*options); };
}

}  // namespace chiaro::cli
