#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace chiaro::cli {

// What every command has.
struct CommonOptions {
  int threads = 0;  // 0: all cores
  std::uint64_t seed = 0;
  bool json = false;                  // the summary as JSON, alone, on standard output
  bool quiet = false;                 // no progress, no warnings, no summary other than --json
  std::vector<std::string> inputs{};  // files that the command line has read
};

void add_common_options(CLI::App& command, CommonOptions& options);

std::string program_version();

}  // namespace chiaro::cli
