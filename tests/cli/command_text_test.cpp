#include "cli/command_text.h"

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/common_options.h"

namespace chiaro::cli {
namespace {

TEST(CommandText, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_quoted("room-2.glb"), "room-2.glb");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("my room.glb"), "'my room.glb'");
  EXPECT_EQ(shell_quoted("it's $(x)"), "'it'\\''s $(x)'");
}

TEST(CommandText, HoldsWhatWasGivenAndChangesResults) {
  CLI::App program;
  CLI::App* command = program.add_subcommand("run", "");
  std::string scene, output, image;
  bool flag = false, other = false;
  CommonOptions common;
  add_input(*command, {"scene", "SCENE", ""}, scene);
  add_output(*command, {"-o,--output", "OUT", ""}, output, {".exr"});
  add_repeated(*command, {"--image", "I", ""}, [](const std::string&) {});
  add_flag(*command, "--flag", flag, "");
  add_flag(*command, "--other", other, "");
  add_common_options(*command, common);
  const std::vector<const char*> line{"chiaro", "run",    "--threads", "2",  "--image", "A b=1.png", "--seed",
                                      "7",      "--flag", "room.glb",  "-o", "x.exr",   "--image",   "C=2.png"};
  program.parse(int(line.size()), line.data());
  EXPECT_EQ(command_text(*command, "again"),
            "chiaro run room.glb --image 'A b=1.png' --image C=2.png --flag --seed 7 -o again");
}

}  // namespace
}  // namespace chiaro::cli
