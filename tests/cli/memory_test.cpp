#include "cli/memory.h"

#include <gtest/gtest.h>

#include <limits>

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

}  // namespace
}  // namespace chiaro::cli
