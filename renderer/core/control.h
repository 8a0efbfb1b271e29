#pragma once
// What a long stage reports to, and how it is asked to stop.

#include <atomic>
#include <cstddef>
#include <functional>
#include <string_view>

namespace chiaro::renderer {

struct Control {
  // Called now and then, from any thread but never from two at once: the stage and the fraction of it done, 0 to 1.
  std::function<void(std::string_view stage, double fraction)> report;
  // Called between the passes of a stage that knows how noisy its result is: relative standard error.
  std::function<void(double relative_standard_error)> report_noise;
  // Set by a signal handler; stages look at it often and throw Interruption.
  const std::atomic<bool>* interrupted = nullptr;

  bool stop_requested() const { return interrupted != nullptr && interrupted->load(std::memory_order_relaxed); }
  void stop_if_requested() const;  // throws Interruption
  // Of a stage that is only to be asked to stop.
  Control without_progress() const { return {.report = {}, .report_noise = {}, .interrupted = interrupted}; }
};

// Runs body(i) for 0 <= i < count on all threads allowed, reports progress under the name `stage`, and throws
// Interruption when asked to stop. Which thread runs which index is not fixed: bodies write to places of their own.
// The first exception thrown by a body is thrown here.
void parallel_for(std::size_t count, std::string_view stage, const Control& control,
                  const std::function<void(std::size_t)>& body);

// The same without progress.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

// While it lives, parallel_for uses at most this many threads. 0 = all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* limit_;
};

// Threads that parallel_for uses now.
int thread_count();

}  // namespace chiaro::renderer
