#include "cli/option_values.h"

#include <gtest/gtest.h>

#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

TEST(CliOptionValues, NumbersAreTakenWhole) {
  EXPECT_EQ(parse_number("0.25", {}), 0.25);
  EXPECT_EQ(parse_number("-1e-3", {}), -0.001);
  EXPECT_EQ(parse_number("+1.5", {}), 1.5) << "as exposures are said";
  for (const char* text : {"", " 1", "1 ", "1,5", "1x", "0x10", "+", "+-1", "++1", "one"}) {
    EXPECT_THROW(parse_number(text, {}), UsageError) << text;
  }
}

TEST(CliOptionValues, NumbersThatAreNotFiniteAreRefused) {
  for (const char* text : {"nan", "NaN", "-nan", "inf", "-inf", "infinity", "1e999"}) {
    EXPECT_THROW(parse_number(text, {}), UsageError) << text;
  }
}

std::string refusal_of_grid(const char* text) {
  try {
    parse_grid(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(CliOptionValues, RangesSayWhetherTheirEndsAreInThem) {
  EXPECT_EQ(refusal_of_grid("0%"), "'0' (expected a number above 0 and at most 100)");
}

TEST(CliOptionValues, RangesHoldAtTheirEnds) {
  EXPECT_EQ(parse_number("0", kNotNegative), 0);
  EXPECT_THROW(parse_number("0", kPositive), UsageError);
  EXPECT_THROW(parse_number("-1e-300", kNotNegative), UsageError);
  EXPECT_EQ(parse_number("1", kZeroToOne), 1);
  EXPECT_THROW(parse_number("1.0000001", kZeroToOne), UsageError);
}

TEST(CliOptionValues, FloatsStayInRangeAfterRounding) {
  EXPECT_EQ(parse_as<float>("0.5", kPositive), 0.5F);
  EXPECT_THROW(parse_as<float>("1e-300", kPositive), UsageError);
  EXPECT_THROW(parse_as<float>("1e300", kPositive), UsageError);
  EXPECT_EQ(parse_as<float>("0.01", {.min = 0.01, .max = 0.1}), 0.01F);
  EXPECT_EQ(parse_as<float>("0.1", {.min = 0.01, .max = 0.1}), 0.1F);
  EXPECT_THROW(parse_as<float>("0.0099", {.min = 0.01}), UsageError);
}

TEST(CliOptionValues, CountsAreWholeNumbersInRange) {
  EXPECT_EQ(parse_count("16", {1, 16}), 16);
  for (const char* text : {"0", "17", "-1", "1.5", "1e1", "", "99999999999999999999"}) {
    EXPECT_THROW(parse_count(text, {1, 16}), UsageError) << text;
  }
}

TEST(CliOptionValues, SeedsSpanSixtyFourBits) {
  EXPECT_EQ(parse_seed("18446744073709551615"), 18446744073709551615ULL);
  EXPECT_THROW(parse_seed("18446744073709551616"), UsageError);
  EXPECT_THROW(parse_seed("-1"), UsageError);
}

TEST(CliOptionValues, ListsHaveExactlyTheirLength) {
  EXPECT_EQ(parse_numbers("1,-2,3.5", 3, {}), (std::vector<double>{1, -2, 3.5}));
  for (const char* text : {"1,2", "1,2,3,4", "1,,3", "1,2,", ",1,2"}) {
    EXPECT_THROW(parse_numbers(text, 3, {}), UsageError) << text;
  }
}

TEST(CliOptionValues, GridsHaveNodesButNotTooMany) {
  EXPECT_EQ(parse_grid("12,8,1").counts, (std::array<int, 3>{12, 8, 1}));
  for (const char* text : {"0,0,0", "4,0,4", "4,4", "4", "-1,4,4", "1000000,1000000,1000000", "101,100,100", "2.5,2,2",
                           "%", "0%", "-1%", "101%", "5,5%", "x%"}) {
    EXPECT_THROW(parse_grid(text), UsageError) << text;
  }
  EXPECT_EQ(parse_grid("100,100,100").counts, (std::array<int, 3>{100, 100, 100}));
  EXPECT_EQ(parse_grid("100,100,100").error, 0);
  EXPECT_DOUBLE_EQ(parse_grid("2.5%").error, 0.025);
  EXPECT_EQ(parse_grid("2.5%").counts, (std::array<int, 3>{}));
}

TEST(CliOptionValues, RegionsAreNamesOrSixNumbers) {
  EXPECT_EQ(parse_region_text("Ceiling, left"), "Ceiling, left");
  EXPECT_EQ(parse_region_text("0,0,0,1,1,1"), "0,0,0,1,1,1");
  EXPECT_EQ(parse_region_text("7"), "7");
  for (const char* text : {"", "1,2", "0,0,0,1,1", "0,0,0,1,1,nan", "0,0,0,1,1,inf", "0,0,0,1,1,1,1"}) {
    EXPECT_THROW(parse_region_text(text), UsageError) << text;
  }
}

TEST(CliOptionValues, AlbedosAreGreyOrColoured) {
  EXPECT_EQ(parse_albedo("0.5"), (renderer::Vec3f{0.5F, 0.5F, 0.5F}));
  EXPECT_EQ(parse_albedo("0.1,0.2,1"), (renderer::Vec3f{0.1F, 0.2F, 1.0F}));
  for (const char* text : {"1.5", "0.1,0.2", "-0.1,0,0", "nan", "0.1,0.2,0.3,0.4", ""}) {
    EXPECT_THROW(parse_albedo(text), UsageError) << text;
  }
}

TEST(CliOptionValues, WordsAreTheOnesAllowed) {
  const std::vector<std::string> allowed{"albedo", "depth", "normal"};
  EXPECT_EQ(parse_words("all", allowed), allowed);
  EXPECT_EQ(parse_words("all,albedo", allowed), allowed);
  EXPECT_EQ(parse_words("normal,albedo,normal", allowed), (std::vector<std::string>{"normal", "albedo"}));
  EXPECT_THROW(parse_words("albedo,colour", allowed), UsageError);
  EXPECT_THROW(parse_words("", allowed), UsageError);
}

}  // namespace
}  // namespace chiaro::cli
