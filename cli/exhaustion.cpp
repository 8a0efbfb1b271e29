#include "cli/exhaustion.h"

#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include <sys/mman.h>
#include <unistd.h>

#include "cli/program.h"
#include "renderer/core/atomic_file.h"

namespace chiaro::cli {
namespace {

// Of those with less some end in a segmentation fault.
constexpr std::size_t kLeastBytes = 96 << 20;
constexpr const char* kTooLittle = "memory: less than 96 MB are left to start with";

std::terminate_handler otherwise = nullptr;

// With what needs no memory.
[[noreturn]] void fail_at_once(const char* what) {
  for (const char* text : {"chiaro: error: ", what, "\n"}) {
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  }
  renderer::remove_unfinished_files();
  ::_exit(kFailed);
}

[[noreturn]] void handle_uncaught() {
  if (std::current_exception()) {
    if (const char* what = what_ran_out()) fail_at_once(what);
  }
  if (otherwise != nullptr) otherwise();
  std::abort();
}

bool has_least_memory() {
  void* const least = ::mmap(nullptr, kLeastBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return least != MAP_FAILED && ::munmap(least, kLeastBytes) == 0;
}

}  // namespace

const char* what_ran_out() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::system_error& error) {
    // A thread is a megabyte of stack and more.
    return error.code() == std::errc::resource_unavailable_try_again ? "out of memory or threads" : nullptr;
  } catch (...) {
    return nullptr;
  }
}

void prepare_for_exhaustion() {
  otherwise = std::set_terminate(handle_uncaught);
  if (!has_least_memory()) fail_at_once(kTooLittle);
}

}  // namespace chiaro::cli
