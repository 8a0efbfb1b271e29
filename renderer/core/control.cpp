#include "renderer/core/control.h"

#include <mutex>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include "renderer/core/error.h"
#include "renderer/core/fork_join.h"

namespace chiaro::renderer {

void Control::stop_if_requested() const {
  if (stop_requested()) throw Interruption();
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  ForkJoin loop;
  const auto run = [&](std::size_t i) CHIARO_UNSEEN_BY_THREAD_SANITIZER {
    const ForkJoin::Body begun(loop);
    body(i);
  };
  tbb::parallel_for(std::size_t{0}, count, run, tbb::simple_partitioner());
}

void parallel_for(std::size_t count, std::string_view stage, const Control& control,
                  const std::function<void(std::size_t)>& body) {
  std::mutex mutex;
  std::size_t done = 0;
  if (control.report) control.report(stage, 0);
  parallel_for(count, [&](std::size_t i) {
    control.stop_if_requested();
    body(i);
    if (!control.report) return;
    const std::lock_guard lock(mutex);
    control.report(stage, double(++done) / double(count));
  });
}

ThreadLimit::ThreadLimit(int threads)
    : limit_(threads > 0 ? new tbb::global_control(tbb::global_control::max_allowed_parallelism, std::size_t(threads))
                         : nullptr) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(limit_); }

int thread_count() { return int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)); }

}  // namespace chiaro::renderer
