#include "cli/memory.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>
#include <vector>

#include <unistd.h>

#include "tests/support/temporary_folder.h"

namespace chiaro::cli {
namespace {

TEST(ControlGroupLimit, IsTheLeastOfAGroupAndThoseAround) {
  const test::TemporaryFolder folder;
  const auto list = folder.write("cgroup", "0::/job/step\n");
  std::filesystem::create_directories(folder / "groups/job/step");
  EXPECT_EQ(control_group_limit(list, folder / "groups"), std::numeric_limits<double>::infinity());
  folder.write("groups/job/step/memory.max", "max\n");
  folder.write("groups/job/memory.max", "8589934592\n");
  EXPECT_EQ(control_group_limit(list, folder / "groups"), 8589934592.0);
  folder.write("groups/memory.max", "1073741824\n");
  EXPECT_EQ(control_group_limit(list, folder / "groups"), 1073741824.0);
}

TEST(ControlGroupLimit, IsThatOfTheMemoryControllerInVersion1) {
  const test::TemporaryFolder folder;
  const auto list = folder.write("cgroup", "9:cpu,cpuacct:/a\n8:memory:/a\nno group\n");
  std::filesystem::create_directories(folder / "groups/memory/a");
  folder.write("groups/memory/a/memory.limit_in_bytes", "4294967296\n");
  EXPECT_EQ(control_group_limit(list, folder / "groups"), 4294967296.0);
}

TEST(MemoryBytes, AreThoseOfThisMachineAtMost) {
  EXPECT_GT(memory_bytes(), 1e6);
  EXPECT_LT(memory_bytes(), 1e15);
}

// In a process of its own.
TEST(LimitMemory, MoreCannotBeAllocated) {
  constexpr double kAllowed = 2e9;
  double pages = 0;
  std::ifstream statm("/proc/self/statm");
  for (int field = 0; field < 6; ++field) statm >> pages;
  if (pages * double(::sysconf(_SC_PAGESIZE)) > kAllowed) GTEST_SKIP() << "sanitizers have mapped more than that";
  const auto allocate = [] {
    limit_memory(kAllowed);
    try {
      const std::vector<char> much(3 * std::size_t(kAllowed));
      std::_Exit(much.empty() ? 1 : 2);
    } catch (const std::bad_alloc&) {
      std::_Exit(0);
    }
  };
  EXPECT_EXIT(allocate(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace chiaro::cli
