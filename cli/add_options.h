#pragma once
// Options of a command, checked while they are parsed. Their faults are UsageErrors that name the option.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/option_values.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace chiaro::cli {

struct OptionText {
  std::string names;  // "-o,--output"
  std::string value;  // shown in --help: "N"
  std::string help;
};

// An option whose text is given to `parse`, which throws UsageError where it is wrong.
CLI::Option* add_parsed(CLI::App& command, const OptionText& text, std::function<void(const std::string&)> parse);

// One that may be given several times; each text is given to `parse`.
CLI::Option* add_repeated(CLI::App& command, const OptionText& text, std::function<void(const std::string&)> parse);

// One that must not be empty.
CLI::Option* add_text(CLI::App& command, const OptionText& text, std::string& value);

CLI::Option* add_flag(CLI::App& command, const std::string& name, bool& value, const std::string& help);

// The value of an option, or the one it may have.
template <class T>
struct NumberOf {
  using Type = T;
};
template <class T>
struct NumberOf<std::optional<T>> {
  using Type = T;
};

template <class T>  // int or std::optional<int>
CLI::Option* add_count(CLI::App& command, const OptionText& text, T& value, CountRange range = {}) {
  return add_parsed(command, text, [&value, range](const std::string& t) { value = parse_count(t, range); });
}

template <class T>  // float, double, or std::optional of one
CLI::Option* add_number(CLI::App& command, const OptionText& text, T& value, NumberRange range = {}) {
  return add_parsed(command, text,
                    [&value, range](const std::string& t) { value = parse_as<typename NumberOf<T>::Type>(t, range); });
}

// A file that the command reads; add_input: one that is required.
CLI::Option* add_input_file(CLI::App& command, const OptionText& text, std::string& value);
CLI::Option* add_input(CLI::App& command, const OptionText& text, std::string& value);

// Makes any option one that names files which the command reads, as FILE or NAME=FILE: no output takes their place.
CLI::Option* naming_inputs(CLI::Option* option);

// What the options that name inputs were given.
std::vector<std::string> input_files(CLI::App& command);

// `-o FILE`, required. `extensions` is what the output may end in.
CLI::Option* add_output(CLI::App& command, const OptionText& text, std::string& value,
                        const std::vector<std::string>& extensions);

bool was_given(const CLI::App& command, const std::string& option);

// Of those that were given: a warning each that it does nothing `why`.
std::vector<std::string> given_for_nothing(const CLI::App& command, const std::vector<std::string>& names,
                                           const std::string& why);

// Of options that were given and do nothing as none of `needed` was: a warning each.
std::vector<std::string> idle_options(const CLI::App& command, const std::vector<std::string>& names,
                                      const std::vector<std::string>& needed);

// Examples shown under --help, one a line.
void set_examples(CLI::App& command, const std::string& examples);

}  // namespace chiaro::cli
