#pragma once

#include <algorithm>
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
  // time_limit: seconds, of all stages but those of transport; 0: none.
  explicit StageClock(double time_limit = 0)
      : limit_(time_limit > 0 ? time_limit : std::numeric_limits<double>::infinity()) {}

  // Ends the stage that has run since the last call; returns its seconds.
  double finish(const std::string& name, StageFigures figures) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    stages_.push_back({name, seconds, std::move(figures)});
    return seconds;
  }
  // The same for one that a search waits for: the limit is so much later.
  double finish_transport(const std::string& name, StageFigures figures) {
    const double seconds = finish(name, std::move(figures));
    limit_ += seconds;
    return seconds;
  }
  double total() const { return renderer::seconds_since(start_); }
  bool is_limited() const { return limit_ < std::numeric_limits<double>::infinity(); }
  double seconds_left() const { return std::max(0.0, limit_ - total()); }  // infinite: no limit
  bool out_of_time() const { return !(seconds_left() > 0); }
  const std::vector<StageReport>& stages() const { return stages_; }

 private:
  using Clock = std::chrono::steady_clock;
  double limit_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
  std::vector<StageReport> stages_;
};

}  // namespace chiaro::inverse
