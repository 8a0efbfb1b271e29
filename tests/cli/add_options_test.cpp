#include "cli/add_options.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace chiaro::cli {
namespace {

TEST(CliAddOptions, OptionsThatDoNothingAreTold) {
  const auto told = [](const std::string& line) {
    CLI::App command;
    std::string a, b, c;
    bool picture = false, lightmap = false;
    add_text(command, {"--a", "A", ""}, a);
    add_text(command, {"-b,--bee", "B", ""}, b);
    add_text(command, {"--c", "C", ""}, c);
    add_flag(command, "--picture", picture, "");
    add_flag(command, "--lightmap", lightmap, "");
    command.parse(line);
    return idle_options(command, {"--a", "--bee"}, {"--picture", "--lightmap"});
  };
  EXPECT_EQ(told("--c 1"), std::vector<std::string>{});
  EXPECT_EQ(told("-b 1 --a 2"), (std::vector<std::string>{"--a: does nothing without --picture or --lightmap",
                                                          "--bee: does nothing without --picture or --lightmap"}));
  EXPECT_EQ(told("-b 1 --lightmap"), std::vector<std::string>{});
}

// They neither take the words after their value nor take one apart.
TEST(CliAddOptions, RepeatedOptionsTakeOneValueEach) {
  CLI::App command;
  std::string scene;
  std::vector<std::string> regions;
  command.add_option("scene", scene)->required();
  add_repeated(command, {"--region", "R", ""}, [&](const std::string& text) { regions.push_back(text); });
  command.parse("--region floor --region \"[a,b]\" room.glb");
  EXPECT_EQ(scene, "room.glb");
  EXPECT_EQ(regions, (std::vector<std::string>{"floor", "[a,b]"}));
}

}  // namespace
}  // namespace chiaro::cli
