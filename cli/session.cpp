#include "cli/session.h"

#include <algorithm>

#include "cli/interruption.h"
#include "cli/output_paths.h"
#include "cli/text_output.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::cli {

Session::Session(const CommonOptions& options)
    : options_(options),
      thread_limit_(options.threads),
      progress_(!options.quiet),
      start_(std::chrono::steady_clock::now()) {
  control_.interrupted = &interruption_flag();
  if (progress_.shown()) {
    control_.report = [this](std::string_view stage, double fraction) { progress_.update(stage, fraction); };
    control_.report_noise = [this](double error) { progress_.set_noise(error); };
  }
}

void Session::warn(const std::string& text) {
  if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) warnings_.push_back(text);
}

void Session::warn(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) warn(text);
}

void Session::stop_if_interrupted() const { control_.stop_if_requested(); }

void Session::require_outputs(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    if (!file.empty()) require_writable(file);
  }
  require_apart(files);
}

void Session::require_outputs_in(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  require_not_a_file(folder);
  std::vector<std::filesystem::path> files;
  for (const std::string& name : names) files.push_back(folder / name);
  for (const std::filesystem::path& file : files) {
    require_file_name(file);
    require_replaceable(file);
  }
  require_apart(files);
}

void Session::require_apart(const std::vector<std::filesystem::path>& files) {
  outputs_.insert(outputs_.end(), files.begin(), files.end());
  cli::require_apart({options_.inputs.begin(), options_.inputs.end()}, outputs_);
}

double Session::seconds() const { return renderer::seconds_since(start_); }

void Session::print_warnings() {
  progress_.clear();
  if (options_.quiet) return;
  for (const std::string& warning : warnings_) print_message("warning: " + warning);
}

void Session::finish(const Json& summary, const std::string& text) {
  print_warnings();
  if (options_.json) {
    print(json_text(summary));
  } else if (!options_.quiet) {
    print(text);
  }
}

}  // namespace chiaro::cli
