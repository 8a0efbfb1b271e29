#include "cli/command_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace chiaro::cli {
namespace {

constexpr std::array<std::string_view, 4> kLeftOut{"output", "threads", "json", "quiet"};

bool is_left_out(const CLI::Option& option) {
  const auto& names = option.get_lnames();
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return std::find(kLeftOut.begin(), kLeftOut.end(), name) != kLeftOut.end();
  });
}

void append_option(std::string& text, const CLI::Option& option) {
  const bool positional = option.get_lnames().empty();
  const std::string name = positional ? "" : " --" + option.get_lnames().front();
  if (option.get_items_expected_max() == 0) {
    text += name;
    return;
  }
  for (const std::string& value : option.results()) text += name + " " + shell_quoted(value);
}

// Colours depend on it where no --ocio is given.
std::string environment_of(const CLI::App& command) {
  const char* config = std::getenv("OCIO");
  const CLI::Option* option = command.get_option_no_throw("--ocio");
  const bool matters = config != nullptr && *config != '\0' && option != nullptr && option->count() == 0;
  return matters ? "OCIO=" + shell_quoted(config) + " " : "";
}

}  // namespace

std::string shell_quoted(const std::string& argument) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-./,=:%+@", c); };
  if (!argument.empty() && std::all_of(argument.begin(), argument.end(), plain)) return argument;
  std::string quoted = "'";
  for (const char c : argument) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string command_text(const CLI::App& command, const std::string& output) {
  std::string text = environment_of(command) + "chiaro " + command.get_name();
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->count() == 0 || is_left_out(*option) || option->get_lnames().empty() != positional) continue;
      append_option(text, *option);
    }
  }
  return text + " -o " + shell_quoted(output);
}

}  // namespace chiaro::cli
