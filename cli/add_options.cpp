#include "cli/add_options.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "cli/named_file.h"
#include "cli/output_paths.h"
#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

std::string last_name(const std::string& names) { return names.substr(names.rfind(',') + 1); }

std::function<void(const std::string&)> naming_the_option(const OptionText& text,
                                                          std::function<void(const std::string&)> parse) {
  return [parse = std::move(parse), name = last_name(text.names)](const std::string& value) {
    try {
      parse(value);
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", name, error.what()));
    }
  };
}

void refuse_empty(const std::string& text) {
  if (text.empty()) throw UsageError("is empty");
}

// CLI11 keeps nothing of others' with an option but checks. This one lets everything pass.
constexpr const char* kNamesInputs = "names inputs";

bool names_inputs(CLI::Option& option) {
  try {
    return option.get_validator(kNamesInputs) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

}  // namespace

CLI::Option* add_parsed(CLI::App& command, const OptionText& text, std::function<void(const std::string&)> parse) {
  return command.add_option_function<std::string>(text.names, naming_the_option(text, std::move(parse)), text.help)
      ->type_name(text.value);
}

CLI::Option* add_repeated(CLI::App& command, const OptionText& text, std::function<void(const std::string&)> parse) {
  const auto each = [parse = naming_the_option(text, std::move(parse))](const std::vector<std::string>& values) {
    for (const std::string& value : values) parse(value);
  };
  return command.add_option_function<std::vector<std::string>>(text.names, each, text.help)
      ->type_name(text.value)
      ->expected(1)
      ->allow_extra_args(false)  // or it takes what follows, and lists in brackets
      ->take_all();
}

CLI::Option* add_text(CLI::App& command, const OptionText& text, std::string& value) {
  return add_parsed(command, text, [&value](const std::string& t) {
    refuse_empty(t);
    value = t;
  });
}

CLI::Option* add_flag(CLI::App& command, const std::string& name, bool& value, const std::string& help) {
  return command.add_flag(name, value, help)->disable_flag_override();
}

CLI::Option* naming_inputs(CLI::Option* option) {
  const auto pass = [](const std::string&) { return std::string(); };
  return option->check(CLI::Validator(pass, "", kNamesInputs));
}

std::vector<std::string> input_files(CLI::App& command) {
  std::vector<std::string> files;
  for (CLI::Option* option : command.get_options()) {
    if (!names_inputs(*option)) continue;
    const bool after_name = option->get_type_name().find('=') != std::string::npos;
    for (const std::string& text : option->results()) {
      files.push_back(after_name ? split_named_file(text).file : text);
    }
  }
  return files;
}

CLI::Option* add_input_file(CLI::App& command, const OptionText& text, std::string& value) {
  return naming_inputs(add_text(command, text, value));
}

CLI::Option* add_input(CLI::App& command, const OptionText& text, std::string& value) {
  return add_input_file(command, text, value)->required();
}

CLI::Option* add_output(CLI::App& command, const OptionText& text, std::string& value,
                        const std::vector<std::string>& extensions) {
  return add_parsed(command, text,
                    [&value, extensions](const std::string& t) {
                      require_extension(t, extensions);
                      value = t;
                    })
      ->required();
}

bool was_given(const CLI::App& command, const std::string& option) { return command.get_option(option)->count() > 0; }

std::vector<std::string> given_for_nothing(const CLI::App& command, const std::vector<std::string>& names,
                                           const std::string& why) {
  std::vector<std::string> warnings;
  for (const std::string& name : names) {
    if (was_given(command, name)) warnings.push_back(fmt::format("{}: does nothing {}", name, why));
  }
  return warnings;
}

std::vector<std::string> idle_options(const CLI::App& command, const std::vector<std::string>& names,
                                      const std::vector<std::string>& needed) {
  const auto given = [&](const std::string& name) { return was_given(command, name); };
  if (std::any_of(needed.begin(), needed.end(), given)) return {};
  return given_for_nothing(command, names, fmt::format("without {}", fmt::join(needed, " or ")));
}

void set_examples(CLI::App& command, const std::string& examples) { command.footer("Example:\n" + examples); }

}  // namespace chiaro::cli
