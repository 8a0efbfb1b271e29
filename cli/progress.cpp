#include "cli/progress.h"

#include <algorithm>
#include <cstdio>

#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "cli/text_output.h"

namespace chiaro::cli {
namespace {

constexpr int kBarWidth = 24;
constexpr double kSecondsBetweenDrawings = 0.1;
constexpr double kAnew = 0.5;  // of how far a stage had come: a fraction below is of another run of it

int terminal_columns() {
  winsize size = {};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string time_left(double fraction, double seconds) {
  if (fraction < 0.01 || seconds < 1) return "";
  return fmt::format("  {} left", text_of_seconds(seconds * (1 - fraction) / fraction));
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

std::string progress_line(std::string_view stage, double fraction, double seconds, int columns) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = int(fraction * kBarWidth);
  const std::string bar = std::string(std::size_t(filled), '#') + std::string(std::size_t(kBarWidth - filled), '.');
  const std::string line = fmt::format("{} [{}] {:3.0f} %{}", stage, bar, 100 * fraction, time_left(fraction, seconds));
  return line.substr(0, std::size_t(std::max(columns - 1, 0)));
}

std::string noise_text(double relative_standard_error) {
  return relative_standard_error > 0 ? fmt::format("  noise {:.2g} %", 100 * relative_standard_error) : "";
}

ProgressBar::ProgressBar(bool wanted) : shown_(wanted && ::isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() { clear(); }

bool StageProgress::update(std::string_view stage, double fraction, Clock::time_point now) {
  const bool begins = stage != stage_ || fraction < kAnew * farthest_;
  if (begins) {
    stage_ = stage;
    begun_ = now;
    farthest_ = 0;
  }
  farthest_ = std::max(farthest_, fraction);
  return begins;
}

void ProgressBar::update(std::string_view stage, double fraction) {
  if (!shown_) return;
  const Clock::time_point now = Clock::now();
  if (progress_.update(stage, fraction, now)) {
    noise_ = 0;
  } else if (seconds_between(last_drawn_, now) < kSecondsBetweenDrawings) {
    return;
  }
  last_drawn_ = now;
  drawn_ = true;
  const std::string noise = noise_text(noise_);
  const int columns = terminal_columns() - int(noise.size());
  const std::string line = progress_line(stage, fraction, seconds_between(progress_.begun(), now), columns) + noise;
  std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace chiaro::cli
