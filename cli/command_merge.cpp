#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "cli/session.h"
#include "cli/text_output.h"
#include "inverse/transport/bake_file.h"

namespace chiaro::cli {
namespace {

struct MergeCommand {
  CommonOptions common;
  std::vector<std::string> parts;
  std::string output;
};

int run_merge(const MergeCommand& options) {
  Session session(options.common);
  session.require_outputs({options.output});
  const std::vector<std::filesystem::path> parts(options.parts.begin(), options.parts.end());
  inverse::merge_transport_caches(parts, options.output, session.control());
  const auto bytes = std::int64_t(std::filesystem::file_size(options.output));
  session.finish(
      JsonObject{{"output", options.output}, {"parts", parts.size()}, {"bytes", bytes}, {"seconds", session.seconds()}},
      aligned_rows({{"parts", fmt::format("{}", parts.size())},
                    {"time", text_of_seconds(session.seconds())},
                    {"written", fmt::format("{}, {}", options.output, text_of_bytes(double(bytes)))}}));
  return kDone;
}

}  // namespace

CommandRun add_merge(CLI::App& command) {
  const auto options = std::make_shared<MergeCommand>();
  naming_inputs(command.add_option("parts", options->parts, "Parts made by `chiaro bake --shard`, in any order"))
      ->required()
      ->type_name("PART.exr");
  add_output(command, {"-o,--output", "C.exr", "The transport cache"}, options->output, {".exr"});
  add_common_options(command, options->common);
  set_examples(command, "  chiaro merge part1.exr part2.exr part3.exr -o room.exr");
  return [options] { return run_merge(*options); };
}

}  // namespace chiaro::cli
