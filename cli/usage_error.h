#pragma once

#include <stdexcept>

namespace chiaro::cli {

// A command line that is wrong in itself, whatever the files hold. The program ends with exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace chiaro::cli
