#include "cli/text_output.h"

#include <gtest/gtest.h>

#include "cli/progress.h"

namespace chiaro::cli {
namespace {

TEST(CliTextOutput, RowsAreAligned) {
  EXPECT_EQ(aligned_rows({{"a", "1"}, {"longer", "2"}}), "  a       1\n  longer  2\n");
}

TEST(CliTextOutput, TablesAlignToTheRight) {
  EXPECT_EQ(table({{"light", "cd"}, {"1", "250"}}), "  light   cd\n  1      250\n");
}

TEST(CliTextOutput, SecondsReadAsPeopleSayThem) {
  EXPECT_EQ(text_of_seconds(0.314), "0.31 s");
  EXPECT_EQ(text_of_seconds(59.97), "1 min 00 s");
  EXPECT_EQ(text_of_seconds(245), "4 min 05 s");
  EXPECT_EQ(text_of_seconds(7500), "2 h 05 min");
}

TEST(CliTextOutput, PercentThatIsNotKnownIsSaidSo) {
  EXPECT_EQ(text_of_percent(0.0412), "4.12 %");
  EXPECT_EQ(text_of_percent(std::nullopt), "not known");
}

TEST(CliTextOutput, IntervalsThatAreNotKnownAreSaidSo) {
  EXPECT_EQ(text_of_interval({0.001F, 0.0123F, 0.002F}), "0.012");
  EXPECT_EQ(text_of_interval({0.001F, renderer::kInfinity, 0.002F}), "not known");
}

TEST(CliTextOutput, BytesHaveDecimalUnits) {
  EXPECT_EQ(text_of_bytes(12), "12 bytes");
  EXPECT_EQ(text_of_bytes(1.5e9), "1.5 GB");
}

TEST(CliTextOutput, OneLineIsOneLine) { EXPECT_EQ(one_line("a\nb\tc\r\n"), "a b c"); }

// Names in files are whatever somebody wrote there.
TEST(CliTextOutput, NamesCannotSpeakToTheTerminal) {
  EXPECT_EQ(one_line("lamp\x1b[31m \xc5\xff \xc3\xbc"), "lamp [31m \xef\xbf\xbd\xef\xbf\xbd \xc3\xbc");
  EXPECT_EQ(aligned_rows({{"light", "a\x1b[2J\nb"}}), "  light  a [2J b\n");
}

// C1 is two bytes each, neither of which is a control character by itself; an override shows what follows backwards.
TEST(CliTextOutput, ControlsBeyondAsciiAreNoneTheLess) {
  EXPECT_EQ(one_line("x\xc2\x9b"
                     "31m"),
            "x 31m");
  EXPECT_EQ(one_line("a\xc2\x80\xc2\x9f\x7fz"), "a   z");
  EXPECT_EQ(one_line("a\xe2\x80\xa8\xe2\x80\xa9z"), "a  z") << "separators of lines and paragraphs";
  EXPECT_EQ(one_line("a\xe2\x80\xae\xe2\x81\xa6z"), "a  z") << "directions";
  const std::string harmless = "\xc2\xa0\xc3\x9b\xe2\x80\xa7\xe2\x80\xaf\xe2\x81\xa5\xe2\x98\x83\xf0\x9f\x92\xa1";
  EXPECT_EQ(one_line(harmless), harmless);
}

TEST(CliTextOutput, WhatIsPrintedKeepsItsLinesAlone) {
  testing::internal::CaptureStdout();
  print("  a\x1b[31m\n  b\xc2\x9bm\xff\n");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "  a [31m\n  b m\xef\xbf\xbd\n");
  testing::internal::CaptureStderr();
  print_message("error: a\nb\x07.glb");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "chiaro: error: a b .glb\n");
}

TEST(CliProgress, LineShowsStageAndPercent) {
  EXPECT_EQ(progress_line("bake", 0.5, 0, 80), "bake [############............]  50 %");
}

TEST(CliProgress, TimeLeftComesFromTheTimeTaken) {
  EXPECT_NE(progress_line("bake", 0.25, 10, 80).find("30.00 s left"), std::string::npos);
}

TEST(CliProgress, LineFitsTheTerminal) {
  EXPECT_LT(progress_line("a stage with a rather long name", 0.5, 10, 20).size(), 20U);
}

TEST(CliProgress, FractionsBeyondTheirRangeDoNotBreakTheBar) {
  EXPECT_EQ(progress_line("x", 1.5, 0, 80), "x [########################] 100 %");
  EXPECT_EQ(progress_line("x", -1, 0, 80), "x [........................]   0 %");
}

TEST(CliProgress, IsOfAnotherRunWhenAStageStartsOver) {
  const StageProgress::Clock::time_point start{};
  const auto at = [&](int seconds) { return start + std::chrono::seconds(seconds); };
  StageProgress progress;
  EXPECT_TRUE(progress.update("tracing", 0, at(0)));
  EXPECT_FALSE(progress.update("tracing", 0.9, at(9)));
  EXPECT_FALSE(progress.update("tracing", 0.88, at(9)));  // told by another thread
  EXPECT_EQ(progress.begun(), at(0));
  EXPECT_TRUE(progress.update("tracing", 0.01, at(10)));
  EXPECT_EQ(progress.begun(), at(10));
  EXPECT_FALSE(progress.update("tracing", 0.02, at(12)));
  EXPECT_TRUE(progress.update("bake", 0.5, at(13)));
  EXPECT_EQ(progress.begun(), at(13));
}

}  // namespace
}  // namespace chiaro::cli
