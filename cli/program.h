#pragma once

namespace chiaro::cli {

// How the program ends.
enum ExitCode : int {
  kDone = 0,
  kFailed = 1,         // bad input or environment: one line on standard error
  kWrongUsage = 2,     // the command line is wrong
  kLimitExceeded = 3,  // `compare --fail-above`
  kInterrupted = 130,  // SIGINT or SIGTERM
};

// Parses the command line and runs the command it names. Throws nothing.
int run_program(int argc, const char* const* argv);

}  // namespace chiaro::cli
