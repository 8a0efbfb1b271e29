#include "cli/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <unistd.h>

namespace chiaro::cli {
namespace {

// Of this process, now.
struct MappedBytes {
  double resident = 0;
  double writable = 0;  // and nobody else's: what RLIMIT_DATA is about
};

// Source: Linux, proc(5).
MappedBytes mapped_bytes() {
  double all = 0, resident = 0, shared = 0, code = 0, libraries = 0, data = 0;  // pages
  std::ifstream("/proc/self/statm") >> all >> resident >> shared >> code >> libraries >> data;
  const double page = double(::sysconf(_SC_PAGESIZE));
  return {resident * page, data * page};
}

// Infinity where there is none, or "max".
double limit_in(const std::filesystem::path& file) {
  double limit = 0;
  return std::ifstream(file) >> limit ? limit : std::numeric_limits<double>::infinity();
}

// As `ulimit -v` and batch systems set them.
double process_limit() {
  double least = std::numeric_limits<double>::infinity();
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit = {};
    if (::getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
      least = std::min(least, double(limit.rlim_cur));
    }
  }
  return least;
}

}  // namespace

double control_group_limit(const std::filesystem::path& list, const std::filesystem::path& groups) {
  double least = std::numeric_limits<double>::infinity();
  std::ifstream lines(list);
  for (std::string line; std::getline(lines, line);) {  // number:controllers:/group, of version 2 without controllers
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == line.npos || second == line.npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (!controllers.empty() && controllers != "memory") continue;
    const auto mounted = groups / controllers;
    const char* file = controllers.empty() ? "memory.max" : "memory.limit_in_bytes";
    std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
    for (; !group.empty(); group = group.parent_path()) least = std::min(least, limit_in(mounted / group / file));
    least = std::min(least, limit_in(mounted / file));
  }
  return least;
}

double memory_bytes() {
  const double installed = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  return std::min({installed, control_group_limit("/proc/self/cgroup", "/sys/fs/cgroup"), process_limit()});
}

double memory_left(std::optional<double> limit) {
  constexpr double kBesides = 100e6;  // threads, file buffers, and what the allocator does not give back
  return limit.value_or(0.75 * memory_bytes()) - mapped_bytes().resident - kBesides;
}

void limit_memory(double bytes) {
  bytes = 1.25 * bytes + 1e9;
  rlimit limit = {};
  if (mapped_bytes().writable > bytes || ::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  if (limit.rlim_cur != RLIM_INFINITY && double(limit.rlim_cur) <= bytes) return;
  limit.rlim_cur = rlim_t(bytes);
  ::setrlimit(RLIMIT_DATA, &limit);
}

double swap_bytes() {
  struct sysinfo info = {};
  return ::sysinfo(&info) == 0 ? double(info.totalswap) * double(info.mem_unit) : 0;
}

}  // namespace chiaro::cli
