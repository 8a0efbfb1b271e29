#pragma once

#include <chrono>
#include <limits>

#include "inverse/solve/solve.h"
#include "renderer/core/seconds_since.h"

namespace chiaro::inverse {

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();  // of a figure

using StageFigures = std::vector<std::pair<std::string, double>>;

// Times the stages of a solve, one after the other.
class StageClock {
 public:
  // Ends the stage that has run since the last call; returns its seconds.
  double finish(const std::string& name, StageFigures figures) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    stages_.push_back({name, seconds, std::move(figures)});
    return seconds;
  }
  double total() const { return renderer::seconds_since(start_); }
  const std::vector<StageReport>& stages() const { return stages_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), last_ = start_;
  std::vector<StageReport> stages_;
};

}  // namespace chiaro::inverse
