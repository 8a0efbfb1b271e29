#pragma once
// What the thread sanitizer cannot see of TBB, which was not compiled with it: that the bodies of a loop come after
// what stands before the loop, and before what stands after it. Nothing in other builds.

#if defined(__SANITIZE_THREAD__)
#define CHIARO_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define CHIARO_THREAD_SANITIZER 1
#endif
#endif

#ifdef CHIARO_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
// Of a function that may read what it was given before it has said that it begins.
#define CHIARO_UNSEEN_BY_THREAD_SANITIZER __attribute__((no_sanitize("thread")))
#else
#define CHIARO_UNSEEN_BY_THREAD_SANITIZER
#endif

namespace chiaro::renderer {

class ForkJoin {
 public:
#ifdef CHIARO_THREAD_SANITIZER
  ForkJoin() { __tsan_release(&forked_); }
  ~ForkJoin() { __tsan_acquire(&joined_); }
#else
  ForkJoin() = default;
  ~ForkJoin() = default;
#endif
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;

  // Lives while a body runs.
  class Body {
   public:
#ifdef CHIARO_THREAD_SANITIZER
    explicit Body(ForkJoin& loop) : loop_(loop) { __tsan_acquire(&loop_.forked_); }
    ~Body() { __tsan_release(&loop_.joined_); }
#else
    explicit Body(ForkJoin& loop) : loop_(loop) {}
    ~Body() = default;
#endif
    Body(const Body&) = delete;
    Body& operator=(const Body&) = delete;

   private:
    [[maybe_unused]] ForkJoin& loop_;
  };

 private:
  [[maybe_unused]] char forked_ = 0, joined_ = 0;
};

}  // namespace chiaro::renderer
