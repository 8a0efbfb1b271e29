#include "renderer/core/atomic_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public ::testing::Test {
 protected:
  std::size_t files() const {
    return std::size_t(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }
  fs::path file() const { return folder_ / "frame.exr"; }

  test::TemporaryFolder folder_;
};

TEST_F(AtomicFile, WritesAndReadsBytes) {
  const std::string bytes("a\0b\xff\n", 5);
  write_file_atomically(file(), bytes);
  EXPECT_EQ(read_file(file()), bytes);
  write_file_atomically(file(), "");
  EXPECT_EQ(read_file(file()), "");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, IsWrittenBesideUnderAnotherNameOfTheSameKind) {
  write_file_atomically(file(), "old");
  write_atomically(file(), [&](const fs::path& aside) {
    EXPECT_NE(aside, file());
    EXPECT_EQ(aside.parent_path(), folder_.path());
    EXPECT_EQ(aside.extension(), ".exr");
    std::ofstream(aside) << "new";
    EXPECT_EQ(read_file(file()), "old");
  });
  EXPECT_EQ(read_file(file()), "new");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, FailureLeavesNothingBehindAndTheOldFile) {
  const auto half = [](const fs::path& aside) {
    std::ofstream(aside) << "half";
    throw Interruption();
  };
  EXPECT_THROW(write_atomically(file(), half), Interruption);
  EXPECT_EQ(files(), 0U);
  write_file_atomically(file(), "old");
  EXPECT_THROW(write_atomically(file(), half), Interruption);
  EXPECT_EQ(read_file(file()), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, SignalHandlersRemoveWhatIsUnfinishedAndNothingElse) {
  write_file_atomically(file(), "old");
  const auto end_by_signal = [](const fs::path& aside) {
    std::ofstream(aside) << "half";
    remove_unfinished_files();
    EXPECT_FALSE(fs::exists(aside));
    throw Interruption();
  };
  EXPECT_THROW(write_atomically(file(), end_by_signal), Interruption);
  remove_unfinished_files();
  EXPECT_EQ(read_file(file()), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, NamesMayBeAsLongAsTheFileSystemHasThem) {
  const fs::path longest = folder_ / (std::string(251, 'a') + ".exr");
  write_file_atomically(longest, "new");
  EXPECT_EQ(read_file(longest), "new");
  EXPECT_THROW(write_file_atomically(folder_ / (std::string(252, 'a') + ".exr"), "new"), Error);
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, IsWrittenThroughNoLink) {
  std::ofstream(folder_ / "victim") << "old";
  fs::create_symlink(folder_ / "victim", file());
  write_file_atomically(file(), "second");
  EXPECT_EQ(read_file(folder_ / "victim"), "old");
  EXPECT_FALSE(fs::is_symlink(file()));
  EXPECT_EQ(read_file(file()), "second");
}

// Other machines and containers that share the folder have processes of the same number.
TEST_F(AtomicFile, IsWrittenUnderANameOfItsOwn) {
  write_atomically(file(), [&](const fs::path& first) {
    std::ofstream(first) << "first";
    write_atomically(file(), [&](const fs::path& second) {
      EXPECT_NE(first, second);
      std::ofstream(second) << "second";
    });
    EXPECT_EQ(read_file(file()), "second");
  });
  EXPECT_EQ(read_file(file()), "first");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFile, HasThePermissionsOfWhatItReplaces) {
  write_file_atomically(file(), "old");
  const fs::perms odd = fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_read;
  fs::permissions(file(), odd);
  write_file_atomically(file(), "new");
  EXPECT_EQ(fs::status(file()).permissions(), odd);
}

TEST_F(AtomicFile, WhatCannotTakeItsPlaceIsKeptAndNamed) {
  fs::path written;
  try {
    write_atomically(file(), [&](const fs::path& aside) {
      written = aside;
      std::ofstream(aside) << "whole";
      fs::create_directories(file() / "in the way");
    });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().file, file().string());
    EXPECT_NE(error.parts().problem.find(written.string()), std::string::npos) << error.what();
  }
  EXPECT_EQ(read_file(written), "whole");
}

TEST_F(AtomicFile, WritingNothingIsAnError) {
  write_file_atomically(file(), "old");
  EXPECT_THROW(write_atomically(file(), [](const fs::path&) {}), Error);
  EXPECT_EQ(read_file(file()), "old");
}

TEST_F(AtomicFile, FoldersThatAreMissingOrInTheWayAreErrors) {
  bool called = false;
  const auto note = [&](const fs::path&) { called = true; };
  EXPECT_THROW(write_atomically(folder_ / "missing" / "frame.exr", note), Error);
  EXPECT_THROW(write_atomically(folder_.path(), note), Error);
  EXPECT_FALSE(called);
}

TEST_F(AtomicFile, ReadingWhatIsNoFileIsAnErrorThatNamesIt) {
  for (const fs::path& path : {folder_ / "missing", folder_.path()}) {
    try {
      read_file(path);
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().file, path.string());
    }
  }
}

// Of zeros that take no room on the disk, as a transfer that has broken off may leave them.
TEST_F(AtomicFile, MoreThanAGlbMayHaveIsNotRead) {
  const fs::path path = folder_ / "large.glb";
  std::ofstream(path).put('{');
  fs::resize_file(path, (std::uintmax_t{1} << 32) + 1);
  EXPECT_NE(test::error_of([&] { read_file(path); }).find("too large"), std::string::npos);
}

}  // namespace
}  // namespace chiaro::renderer
