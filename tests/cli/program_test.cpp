#include "cli/program.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/cli/run_with.h"
#include "tests/support/test_names.h"

namespace chiaro::cli {
namespace {

using tests::Outcome;
using tests::run_with;

auto line_count(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

class CliWrongUsage : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(CliWrongUsage, ExitsWithTwoAndOneOrTwoLines) {
  const Outcome outcome = run_with(GetParam());
  EXPECT_EQ(outcome.exit_code, kWrongUsage);
  EXPECT_EQ(outcome.standard_output, "");
  EXPECT_EQ(outcome.standard_error.rfind("chiaro: usage: ", 0), 0U) << outcome.standard_error;
  EXPECT_LE(line_count(outcome.standard_error), 2);
}

using Arguments = std::vector<std::string>;

std::string name_of(const testing::TestParamInfo<Arguments>& info) {
  std::string words;
  for (const std::string& word : info.param) words += " " + (word.empty() ? "empty" : word);
  return test::test_name(words);
}

INSTANTIATE_TEST_SUITE_P(
    CommandLines, CliWrongUsage,
    testing::Values(
        Arguments{}, Arguments{"paintt"}, Arguments{"inspect"}, Arguments{"inspect", "a.glb", "b.glb"},
        Arguments{"inspect", ""}, Arguments{"render", "a.glb"}, Arguments{"render", "a.glb", "-o", "a.png"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--samples", "0"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--width", "-5"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--time", "nan"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--layers", "smell"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--exposure", "dark"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--filter", "gauss"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--threads", "-1"},
        Arguments{"render", "a.glb", "-o", "a.exr", "--samples"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--grid", "0,0,0"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--bounces", "-1"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--shard", "0/4"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--shard", "5/4"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--shard", "2"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--memory", "4X"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--memory", "0G"}, Arguments{"merge", "-o", "a.exr"},
        Arguments{"merge", "part.exr"}, Arguments{"bake", "a.glb", "-o", "a.exr", "--albedo", "2"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--materials", "gold"},
        Arguments{"bake", "a.glb", "-o", "a.exr", "--on", "r.glb", "--max-edge", "1"},
        Arguments{"receivers", "a.glb", "-o", "r.glb", "--max-edge", "0"},
        Arguments{"receivers", "a.glb", "-o", "r.glb", "--variant", ""}, Arguments{"solve", "a.glb", "-o", "l.glb"},
        Arguments{"solve", "a.glb", "--target", "t.glb", "-o", "l.json"},
        Arguments{"solve", "a.glb", "--target", "t.glb", "-o", "l.glb", "--method", "guess"},
        Arguments{"solve", "a.glb", "--target", "t.glb", "-o", "l.glb", "--importance-weights", "0,0"},
        Arguments{"solve", "a.glb", "--target", "t.glb", "-o", "l.glb", "--max-lights", "0"},
        Arguments{"solve", "a.glb", "--target", "t.glb", "-o", "l.glb", "--lights", "3", "--max-lights", "2"},
        Arguments{"solve", "a.glb", "--target", "t.glb", "-o", "l.glb", "--lights", "3", "--keep-positions"},
        Arguments{"solve", "a.glb", "--target", "t.glb", "-o", "l.glb", "--cache", "c.exr", "--grid", "2,2,2"},
        Arguments{"paint", "a.glb", "--strokes", "s.json", "-o", "t.glb", "--unpainted-weight", "-1"},
        Arguments{"compare", "a.exr", "b.exr", "--fail-above", "-1"},
        Arguments{"compare", "a.glb", "b.glb", "-o", "d.png"}),
    name_of);

// As scripts write options of empty variables: the next word is no value of theirs.
TEST(CliProgram, EmptyValuesAreRefused) {
  for (const Arguments& words : {Arguments{"solve", "--lights=", "3", "room.glb"}, {"render", "--seed=", "--quiet"}}) {
    const Outcome outcome = run_with(words);
    EXPECT_EQ(outcome.exit_code, kWrongUsage);
    EXPECT_NE(outcome.standard_error.find("is empty"), std::string::npos) << outcome.standard_error;
  }
  EXPECT_EQ(run_with({"inspect", "room.glb", "--quiet=5"}).exit_code, kWrongUsage);
}

TEST(CliProgram, AMissingFileIsOneLineOfError) {
  const Outcome outcome = run_with({"inspect", "no/such/file.glb"});
  EXPECT_EQ(outcome.exit_code, kFailed);
  EXPECT_EQ(outcome.standard_output, "");
  EXPECT_EQ(outcome.standard_error.rfind("chiaro: error: no/such/file.glb: ", 0), 0U) << outcome.standard_error;
  EXPECT_EQ(line_count(outcome.standard_error), 1);
}

TEST(CliProgram, HelpOfEveryCommandHasAnExample) {
  for (const char* command :
       {"inspect", "receivers", "illuminate", "paint", "bake", "merge", "solve", "render", "compare", "run"}) {
    const Outcome outcome = run_with({command, "--help"});
    EXPECT_EQ(outcome.exit_code, kDone) << command;
    EXPECT_NE(outcome.standard_output.find("Example:\n  chiaro " + std::string(command)), std::string::npos) << command;
    EXPECT_EQ(outcome.standard_error, "") << command;
    for (const char* option : {"--threads", "--seed", "--json", "--quiet"}) {
      EXPECT_NE(outcome.standard_output.find(option), std::string::npos) << command << " " << option;
    }
  }
}

TEST(CliProgram, VersionNamesTheProgram) {
  const Outcome outcome = run_with({"--version"});
  EXPECT_EQ(outcome.exit_code, kDone);
  EXPECT_EQ(outcome.standard_output.rfind("chiaro ", 0), 0U) << outcome.standard_output;
}

}  // namespace
}  // namespace chiaro::cli
