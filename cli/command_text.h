#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chiaro::cli {

// The command line that gives the same results: the options that were given, in the order of --help, quoted for a
// POSIX shell; without those that change nothing in them (--threads, --json, --quiet), and with `-o OUTPUT` instead of
// where they went.
std::string command_text(const CLI::App& command, const std::string& output);

// One argument, quoted where a shell would take it for something else.
std::string shell_quoted(const std::string& argument);

}  // namespace chiaro::cli
