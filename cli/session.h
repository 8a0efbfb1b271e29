#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "cli/common_options.h"
#include "cli/json_output.h"
#include "cli/progress.h"
#include "renderer/core/control.h"

namespace chiaro::cli {

// What a command has while it runs: the thread limit, progress, interruption and warnings.
// Warnings are held back to the end: a command that fails prints its one line of error and nothing else.
class Session {
 public:
  explicit Session(const CommonOptions& options);

  const renderer::Control& control() const { return control_; }
  void warn(const std::string& text) { warnings_.push_back(text); }
  void warn(const std::vector<std::string>& texts);
  // After a stage that does not look at the control itself.
  void stop_if_interrupted() const;
  double seconds() const;  // since the start

  // Prints the warnings, and the summary: as JSON, or as the text for people unless --quiet.
  void finish(const Json& summary, const std::string& text);

 private:
  void print_warnings();

  CommonOptions options_;
  renderer::ThreadLimit thread_limit_;
  ProgressBar progress_;
  renderer::Control control_;
  std::vector<std::string> warnings_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace chiaro::cli
