#include "cli/output_paths.h"

#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "cli/session.h"
#include "cli/usage_error.h"
#include "renderer/core/error.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::cli {
namespace {

namespace fs = std::filesystem;

class CliOutputPaths : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(CliOutputPaths, ExtensionsDoNotMindCase) {
  EXPECT_NO_THROW(require_extension("a.GLB", {".glb", ".gltf"}));
  EXPECT_THROW(require_extension("a.json", {".glb", ".gltf"}), UsageError);
  EXPECT_THROW(require_extension("glb", {".glb"}), UsageError);
}

TEST_F(CliOutputPaths, AskingWhetherAFileCanBeMadeLeavesNothing) {
  require_writable(folder_ / "new.exr");
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(CliOutputPaths, WhatCannotBeMadeIsAnError) {
  EXPECT_THROW(require_writable(folder_ / "missing" / "new.exr"), renderer::Error);
  EXPECT_THROW(require_writable(folder_.path()), renderer::Error);
  folder_.write("file", "text");
  EXPECT_THROW(require_writable(folder_ / "file" / "new.exr"), renderer::Error);
  NewFolders folders;
  EXPECT_THROW(folders.make(folder_ / "file"), renderer::Error);
  EXPECT_THROW(folders.make(folder_ / "file" / "below"), renderer::Error);
}

TEST_F(CliOutputPaths, FoldersAreMadeWithThoseAboveAndGoAgainWhereTheyStayEmpty) {
  fs::create_directory(folder_ / "old");
  {
    NewFolders folders;
    folders.make(folder_ / "old");
    folders.make(folder_ / "a" / "b");
    folders.make(folder_ / "a" / "b");
    folders.make(folder_ / "a" / "c");
    folders.make(folder_ / "d" / "e");
    EXPECT_TRUE(fs::is_empty(folder_ / "a" / "b"));
    folder_.write("a/c/output", "text");
  }
  EXPECT_TRUE(fs::exists(folder_ / "a" / "c" / "output"));
  EXPECT_FALSE(fs::exists(folder_ / "a" / "b"));
  EXPECT_FALSE(fs::exists(folder_ / "d"));
  EXPECT_TRUE(fs::exists(folder_ / "old")) << "it was there before";
}

TEST_F(CliOutputPaths, NamesBesideKeepTheirStem) {
  EXPECT_EQ(beside("x/lights.glb", ".json"), fs::path("x/lights.json"));
  EXPECT_EQ(beside("Camera.001.exr", ".png"), fs::path("Camera.001.png"));
}

TEST_F(CliOutputPaths, NamesOfUsersBecomeFileNames) {
  EXPECT_EQ(file_name_of("Camera.001"), "Camera.001");
  EXPECT_EQ(file_name_of("../x y/z"), "_._x_y_z");
  EXPECT_EQ(file_name_of(""), "unnamed");
  EXPECT_EQ(file_name_of("Küche"), "Küche");
  EXPECT_EQ(file_name_of("a" + std::string(98, 'b') + "ü"), "a" + std::string(98, 'b')) << "no half of a character";
}

TEST_F(CliOutputPaths, OutputsNeverTakeThePlaceOfInputsOrOfEachOther) {
  fs::create_directories(folder_ / "b");
  folder_.write("a.glb", "x");
  fs::create_symlink(folder_ / "a.glb", folder_ / "link.glb");
  EXPECT_THROW(require_apart({folder_ / "a.glb"}, {folder_ / "b/../a.glb"}), renderer::Error);
  EXPECT_THROW(require_apart({}, {folder_ / "c.glb", folder_ / "b/../c.glb"}), renderer::Error);
  EXPECT_NO_THROW(require_apart({folder_ / "a.glb", ""}, {folder_ / "b/a.glb", folder_ / "a.json", ""}));
  EXPECT_NO_THROW(require_apart({folder_ / "a.glb"}, {folder_ / "link.glb"}));  // the link itself is replaced
}

// In a folder such as /tmp each replaces only what is their own.
TEST_F(CliOutputPaths, WhatCannotBeReplacedIsAnError) {
  if (::geteuid() != 0) GTEST_SKIP() << "no files of other users can be made";
  constexpr uid_t kOwner = 1, kOther = 2, kUser = 65534;
  folder_.write("theirs.exr", "x");
  folder_.write("own.exr", "x");
  fs::permissions(folder_.path(), fs::perms::all | fs::perms::sticky_bit);
  ASSERT_EQ(::chown(folder_.path().c_str(), kOwner, kOwner), 0);
  ASSERT_EQ(::chown((folder_ / "theirs.exr").c_str(), kOther, kOther), 0);
  ASSERT_EQ(::chown((folder_ / "own.exr").c_str(), kUser, kUser), 0);
  ASSERT_EQ(::seteuid(kUser), 0);
  EXPECT_THROW(require_writable(folder_ / "theirs.exr"), renderer::Error);
  EXPECT_NO_THROW(require_writable(folder_ / "own.exr"));
  EXPECT_NO_THROW(require_writable(folder_ / "new.exr"));
  Session session(CommonOptions{.threads = 0, .seed = 0, .json = false, .quiet = true});
  EXPECT_THROW(session.require_outputs_in(folder_.path(), {"new.exr", "theirs.exr"}), renderer::Error);
  ASSERT_EQ(::seteuid(0), 0);
}

TEST_F(CliOutputPaths, PipesAndSocketsAreNotReplaced) {
  const std::filesystem::path pipe = folder_ / "pipe.exr";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(test::error_of([&] { require_writable(pipe); }).find("it is a pipe, a socket or a device"),
            std::string::npos);
}

TEST_F(CliOutputPaths, InputsAreWhatLinksLeadTo) {
  folder_.write("a.glb", "x");
  fs::create_symlink("a.glb", folder_ / "inner.glb");
  fs::create_symlink(folder_ / "inner.glb", folder_ / "outer.glb");
  fs::create_symlink("loop.glb", folder_ / "loop.glb");
  fs::create_hard_link(folder_ / "a.glb", folder_ / "hard.glb");
  for (const char* output : {"a.glb", "inner.glb", "outer.glb"}) {
    EXPECT_THROW(require_apart({folder_ / "outer.glb"}, {folder_ / output}), renderer::Error) << output;
  }
  EXPECT_NO_THROW(require_apart({folder_ / "outer.glb", folder_ / "loop.glb"}, {folder_ / "hard.glb"}));
}

TEST_F(CliOutputPaths, WhatInputsReferToIsAnInput) {
  folder_.write("scene.gltf", R"({"buffers": [{"uri": "buffer.glb"}]})");
  folder_.write("buffer.glb", "x");
  fs::create_symlink("scene.gltf", folder_ / "link.gltf");
  EXPECT_THROW(require_apart({folder_ / "scene.gltf"}, {folder_ / "buffer.glb"}), renderer::Error);
  EXPECT_THROW(require_apart({folder_ / "link.gltf"}, {folder_ / "buffer.glb"}), renderer::Error);
  EXPECT_NO_THROW(require_apart({folder_ / "scene.gltf"}, {folder_ / "other.glb"}));
  fs::rename(folder_ / "buffer.glb", folder_ / "other.glb");
  fs::create_symlink("other.glb", folder_ / "buffer.glb");
  for (const char* output : {"buffer.glb", "other.glb"}) {
    EXPECT_THROW(require_apart({folder_ / "scene.gltf"}, {folder_ / output}), renderer::Error) << output;
  }
}

}  // namespace
}  // namespace chiaro::cli
