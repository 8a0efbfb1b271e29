#include "cli/memory.h"

#include <fstream>

#include <unistd.h>

namespace chiaro::cli {
namespace {

// Of this process, now.
double resident_bytes() {
  double all = 0, resident = 0;  // pages
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * double(::sysconf(_SC_PAGESIZE));
}

}  // namespace

double memory_bytes() { return double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE)); }

double memory_left(std::optional<double> limit) {
  constexpr double kBesides = 100e6;  // threads, file buffers, and what the allocator does not give back
  return limit.value_or(0.75 * memory_bytes()) - resident_bytes() - kBesides;
}

}  // namespace chiaro::cli
