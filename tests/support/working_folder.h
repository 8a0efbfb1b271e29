#pragma once

#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace chiaro::test {

// A temporary folder that the process works in as long as there is one.
class WorkingFolder : public TemporaryFolder {
 public:
  WorkingFolder() { std::filesystem::current_path(path()); }
  ~WorkingFolder() {
    std::error_code ignored;
    std::filesystem::current_path(before_, ignored);
  }

 private:
  const std::filesystem::path before_ = std::filesystem::current_path();
};

}  // namespace chiaro::test
