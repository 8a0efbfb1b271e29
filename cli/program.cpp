#include "cli/program.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/exhaustion.h"
#include "cli/memory.h"
#include "cli/text_output.h"
#include "cli/usage_error.h"
#include "renderer/core/error.h"

namespace chiaro::cli {
namespace {

struct CommandEntry {
  const char* name;
  const char* description;
  CommandRun (*add)(CLI::App&);
};

constexpr CommandEntry kCommands[] = {
    {"inspect", "Say what is in a scene, light file, target, cache or frame", add_inspect},
    {"receivers", "Write the surfaces on which illumination lives, to paint on", add_receivers},
    {"illuminate", "Trace the illumination of every receiver under given lights", add_illuminate},
    {"paint", "Apply brush strokes to an illumination", add_paint},
    {"bake", "Compute the transport of a grid of unity lights to every receiver", add_bake},
    {"merge", "Join the parts of a bake", add_merge},
    {"solve", "Find the lights that produce a painted illumination", add_solve},
    {"render", "Render the final frame", add_render},
    {"compare", "Compare two frames or two targets", add_compare},
    {"run", "Bake, solve, render every camera and compare with the target", add_run},
};

using AddedCommands = std::vector<std::pair<CLI::App*, CommandRun>>;

AddedCommands add_commands(CLI::App& program) {
  AddedCommands added;
  for (const CommandEntry& entry : kCommands) {
    CLI::App* command = program.add_subcommand(entry.name, entry.description);
    added.emplace_back(command, entry.add(*command));
  }
  return added;
}

int run_parsed_command(const AddedCommands& commands) {
  for (const auto& [command, run] : commands) {
    if (command->parsed()) return run();
  }
  return kWrongUsage;
}

int fail_usage(const CLI::App& program, const std::string& message) {
  const auto selected = program.get_subcommands();
  const std::string command = selected.empty() ? "" : " " + selected.front()->get_name();
  print_message("usage: " + message);
  print_message("see 'chiaro" + command + " --help'");
  return kWrongUsage;
}

int fail(const std::string& message) {
  print_message("error: " + message);
  return kFailed;
}

// CLI11 would ask for a subcommand and not say what is wrong with the word.
void require_known_command(const CLI::App& program, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return;
  throw UsageError(fmt::format("'{}' is no command (expected one of: {})", argv[1], fmt::join(names, ", ")));
}

// `--lights=` with nothing behind it, as scripts write of an empty variable: CLI11 would take what follows.
void refuse_empty_values(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word.starts_with("--") && word.ends_with('=')) {
      throw UsageError(fmt::format("{}: is empty (expected a value)", word.substr(0, word.size() - 1)));
    }
  }
}

int parse_and_run(CLI::App& program, const AddedCommands& commands, int argc, const char* const* argv) {
  try {
    require_known_command(program, argc, argv);
    refuse_empty_values(argc, argv);
    program.parse(argc, argv);
    return run_parsed_command(commands);
  } catch (const CLI::Success& help_or_version) {
    std::ostringstream text;
    const int code = program.exit(help_or_version, text, text);
    print(text.str());
    return code;
  } catch (const CLI::ParseError& error) {
    return fail_usage(program, error.what());
  } catch (const UsageError& error) {
    return fail_usage(program, error.what());
  }
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  try {
    limit_memory(memory_bytes() + swap_bytes());
    CLI::App program("chiaro finds the lights that make a 3D scene look the way somebody painted it.", "chiaro");
    program.require_subcommand(1);
    program.set_version_flag("--version", "chiaro " + program_version());
    program.footer("Example:\n  chiaro run room.glb --target painted.glb -o room_lit");
    const AddedCommands commands = add_commands(program);
    return parse_and_run(program, commands, argc, argv);
  } catch (const renderer::Interruption& interruption) {
    print_message(interruption.what());
    return kInterrupted;
  } catch (const std::exception& error) {
    const char* exhausted = what_ran_out();
    return fail(exhausted != nullptr ? exhausted : error.what());
  }
}

}  // namespace chiaro::cli
