#pragma once

#include <cstdlib>

#include <CLI/CLI.hpp>

namespace chiaro::benchmarks {

// Ends the program, as wrong usage and --help do, where there is nothing to measure.
inline void parse_or_exit(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Error& error) {
    std::exit(app.exit(error));
  }
}

}  // namespace chiaro::benchmarks
