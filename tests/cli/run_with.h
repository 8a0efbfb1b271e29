#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace chiaro::cli::tests {

struct Outcome {
  int exit_code = 0;
  std::string standard_output, standard_error;
};

// The program with these arguments after its name.
inline Outcome run_with(const std::vector<std::string>& arguments) {
  std::vector<const char*> all{"chiaro"};
  for (const std::string& argument : arguments) all.push_back(argument.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.exit_code = run_program(int(all.size()), all.data());
  outcome.standard_output = testing::internal::GetCapturedStdout();
  outcome.standard_error = testing::internal::GetCapturedStderr();
  return outcome;
}

}  // namespace chiaro::cli::tests
