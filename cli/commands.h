#pragma once
// The commands. To add one: a file command_NAME.cpp, a line here, and one in program.cpp.

#include <functional>

namespace CLI {
class App;
}

namespace chiaro::cli {

// Runs a command whose options are parsed; returns an ExitCode.
using CommandRun = std::function<int()>;

// Each adds its options to `command` and returns what runs it.
CommandRun add_inspect(CLI::App& command);
CommandRun add_receivers(CLI::App& command);
CommandRun add_illuminate(CLI::App& command);
CommandRun add_paint(CLI::App& command);
CommandRun add_bake(CLI::App& command);
CommandRun add_merge(CLI::App& command);
CommandRun add_solve(CLI::App& command);
CommandRun add_render(CLI::App& command);
CommandRun add_compare(CLI::App& command);
CommandRun add_run(CLI::App& command);

}  // namespace chiaro::cli
