#pragma once

#include <chrono>
#include <filesystem>
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
  // Once, however often a file is read.
  void warn(const std::string& text);
  void warn(const std::vector<std::string>& texts);
  // After a stage that does not look at the control itself.
  void stop_if_interrupted() const;
  double seconds() const;  // since the start

  // Every command's first: Error where an output cannot be made, or would take the place of an input, of a file that an
  // input refers to, or of another output. Empty paths count for nothing.
  void require_outputs(const std::vector<std::filesystem::path>& files);
  // The same of files in a folder that is made when the inputs are known to be good.
  void require_outputs_in(const std::filesystem::path& folder, const std::vector<std::string>& names);

  // Prints the warnings, and the summary: as JSON, or as the text for people unless --quiet.
  void finish(const Json& summary, const std::string& text);

 private:
  void print_warnings();
  void require_apart(const std::vector<std::filesystem::path>& files);

  CommonOptions options_;
  renderer::ThreadLimit thread_limit_;
  ProgressBar progress_;
  renderer::Control control_;
  std::vector<std::string> warnings_;
  std::vector<std::filesystem::path> outputs_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace chiaro::cli
