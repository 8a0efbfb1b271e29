#include "renderer/core/file_lock.h"

#include <gtest/gtest.h>

#include <optional>

#include "renderer/core/error.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

TEST(FileLock, OneHoldsAFileAtATime) {
  const test::TemporaryFolder folder;
  std::optional<FileLock> first(folder / "a");
  EXPECT_THROW(FileLock(folder / "a"), Error);
  const FileLock other(folder / "b");
  first.reset();
  EXPECT_NO_THROW(FileLock(folder / "a"));
}

TEST(FileLock, GoesWithTheFileWhateverItsName) {
  const test::TemporaryFolder folder;
  FileLock held(folder / "a");
  std::filesystem::rename(folder / "a", folder / "b");
  EXPECT_THROW(FileLock(folder / "b"), Error);
  EXPECT_NO_THROW(FileLock(folder / "a"));
  const FileLock taken = std::move(held);
  EXPECT_THROW(FileLock(folder / "b"), Error);
}

TEST(FileLock, OneWorksInAFolderAtATime) {
  const test::TemporaryFolder folder;
  std::optional<FileLock> first(FileLock::of_folder(folder.path()));
  EXPECT_THROW(FileLock::of_folder(folder.path()), Error);
  const FileLock of_a_file_in_it(folder / "a");
  first.reset();
  EXPECT_NO_THROW(FileLock::of_folder(folder.path()));
}

TEST(FileLock, WhatCannotBeMadeIsAnError) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(FileLock(folder / "missing/a"), Error);
}

}  // namespace
}  // namespace chiaro::renderer
