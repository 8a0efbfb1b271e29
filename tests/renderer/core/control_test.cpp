#include "renderer/core/control.h"

#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

TEST(ParallelFor, RunsEveryIndexOnce) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
    std::vector<std::atomic<int>> runs(count);
    parallel_for(count, [&](std::size_t i) { ++runs[i]; });
    for (const auto& n : runs) EXPECT_EQ(n, 1);
  }
}

TEST(ParallelFor, ThrowsWhatABodyThrows) {
  const auto body = [](std::size_t i) {
    if (i == 37) throw Error({"scene.glb", "here", "broken", ""});
  };
  EXPECT_THROW(parallel_for(100, body), Error);
  EXPECT_THROW(parallel_for(100, "stage", {}, body), Error);
  try {
    parallel_for(100, "stage", {}, body);
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "scene.glb: here: broken");
  }
}

TEST(ParallelFor, StopsWhenAskedTo) {
  std::atomic<bool> interrupted{false};
  std::atomic<int> runs{0};
  Control control;
  control.interrupted = &interrupted;
  const auto body = [&](std::size_t) {
    if (++runs == 10) interrupted = true;
  };
  EXPECT_THROW(parallel_for(100000, "stage", control, body), Interruption);
  EXPECT_LT(runs, 1000);
  runs = 0;
  EXPECT_THROW(parallel_for(10, "stage", control, body), Interruption);
  EXPECT_EQ(runs, 0);
}

TEST(ParallelFor, ReportsProgressThatOnlyGrows) {
  std::vector<double> fractions;
  std::atomic<int> inside{0};
  bool overlapped = false;
  Control control;
  control.report = [&](std::string_view stage, double fraction) {
    overlapped = overlapped || ++inside != 1;
    EXPECT_EQ(stage, "stage");
    fractions.push_back(fraction);
    --inside;
  };
  parallel_for(500, "stage", control, [](std::size_t) {});
  ASSERT_GE(fractions.size(), 2U);
  EXPECT_FALSE(overlapped);
  EXPECT_GE(fractions.front(), 0);
  EXPECT_DOUBLE_EQ(fractions.back(), 1);
  for (std::size_t i = 1; i < fractions.size(); ++i) EXPECT_GE(fractions[i], fractions[i - 1]);
}

std::size_t threads_used() {
  std::mutex mutex;
  std::set<std::thread::id> ids;
  parallel_for(32, [&](std::size_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  return ids.size();
}

TEST(ThreadLimit, HoldsWhileItLives) {
  const int before = thread_count();
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(thread_count(), 1);
    EXPECT_EQ(threads_used(), 1U);
  }
  EXPECT_EQ(thread_count(), before);
  const ThreadLimit all(0);
  EXPECT_EQ(thread_count(), before);
}

}  // namespace
}  // namespace chiaro::renderer
