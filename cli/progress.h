#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace chiaro::cli {

// One line of a progress bar, `columns` wide at most: the stage, a bar, percent, and the time left when it can be told
// from the seconds the stage has taken.
std::string progress_line(std::string_view stage, double fraction, double seconds, int columns);

// How noisy the result is so far, after the line.
std::string noise_text(double relative_standard_error);

// When the stage that runs has begun. Stages of one name run several times in a row, each from the start.
class StageProgress {
 public:
  using Clock = std::chrono::steady_clock;

  // Whether a stage begins by this.
  bool update(std::string_view stage, double fraction, Clock::time_point now);
  Clock::time_point begun() const { return begun_; }

 private:
  std::string stage_;
  double farthest_ = 0;  // that the stage has come
  Clock::time_point begun_;
};

// A progress bar on standard error, redrawn in place.
class ProgressBar {
 public:
  // Shows nothing unless `wanted` and standard error is a terminal.
  explicit ProgressBar(bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  bool shown() const { return shown_; }
  void update(std::string_view stage, double fraction);
  // Shown behind the time left until the next stage begins.
  void set_noise(double relative_standard_error) { noise_ = relative_standard_error; }
  void clear();

 private:
  using Clock = StageProgress::Clock;
  bool shown_;
  bool drawn_ = false;
  StageProgress progress_;
  double noise_ = 0;  // 0: not known
  Clock::time_point last_drawn_;
};

}  // namespace chiaro::cli
