#pragma once
// Errors of input and environment, interruption, and checks of our own invariants.

#include <stdexcept>
#include <string>
#include <utility>

namespace chiaro::renderer {

// A fault of the input or the environment. what() reads `FILE: PLACE: PROBLEM (EXPECTED)`; empty parts are left out.
class Error : public std::runtime_error {
 public:
  struct Parts {
    std::string file;      // the file or device at fault
    std::string place;     // where in it: "accessors[3]", "header", "option --grid"
    std::string problem;   // what was found
    std::string expected;  // what would have been right
  };
  explicit Error(Parts parts) : std::runtime_error(format(parts)), parts_(std::move(parts)) {}
  const Parts& parts() const { return parts_; }

 private:
  static std::string format(const Parts& parts);
  Parts parts_;
};

// Thrown where a stage was asked to stop (Control::interrupted).
class Interruption : public std::runtime_error {
 public:
  // What is left of the work, if anything.
  explicit Interruption(const std::string& left = "")
      : std::runtime_error(left.empty() ? "interrupted" : "interrupted: " + left) {}
};

[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace chiaro::renderer

// An invariant of ours, not of the input: a failure is a bug and aborts with its place.
#define CHIARO_CHECK(condition) \
  ((condition) ? (void)0 : ::chiaro::renderer::check_failed(#condition, __FILE__, __LINE__))
