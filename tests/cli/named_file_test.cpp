#include "cli/named_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace chiaro::cli {
namespace {

using test::TemporaryFolder;

void expect_split(const std::string& text, const std::string& name, const std::string& file) {
  const NamedFile named = split_named_file(text);
  EXPECT_EQ(named.name, name) << text;
  EXPECT_EQ(named.file, file) << text;
}

TEST(NamedFile, IsSplitAtTheFirstSign) {
  expect_split("Camera=nowhere.png", "Camera", "nowhere.png");
  expect_split("nowhere.png", "", "nowhere.png");
  expect_split("Camera=nowhere=2.png", "Camera", "nowhere=2.png");
  expect_split("Camera=", "Camera", "");
}

TEST(NamedFile, IsSplitWhereThereIsAFile) {
  const TemporaryFolder folder;
  const std::string plain = folder.write("frame.png", "").string(), odd = folder.write("gain=2.png", "").string();
  expect_split("lens=35=" + plain, "lens=35", plain);
  expect_split("Camera=" + odd, "Camera", odd);
  expect_split("lens=35=" + odd, "lens=35", odd);
  expect_split(odd, "", odd);
}

}  // namespace
}  // namespace chiaro::cli
