#include "cli/common_options.h"

#include <CLI/CLI.hpp>

#include "cli/add_options.h"

namespace chiaro::cli {

void add_common_options(CLI::App& command, CommonOptions& options) {
  add_count(command, {"--threads", "N", "Threads to use, 0 = all cores (default 0)"}, options.threads, {0, 1024});
  add_parsed(command, {"--seed", "N", "Seed of all random numbers (default 0)"},
             [&options](const std::string& text) { options.seed = parse_seed(text); });
  add_flag(command, "--json", options.json, "Print the summary as JSON, alone, on standard output");
  add_flag(command, "--quiet", options.quiet, "No progress, no warnings, no summary (but that of --json)");
  command.final_callback([&command, &options] { options.inputs = input_files(command); });
  command.set_version_flag("--version", "chiaro " + program_version());
}

std::string program_version() { return CHIARO_VERSION; }

}  // namespace chiaro::cli
