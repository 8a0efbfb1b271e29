#include "cli/json_output.h"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace chiaro::cli {
namespace {

TEST(CliJsonOutput, ReadsBackAsWhatItWas) {
  const JsonObject object{{"text", "a \"quoted\"\nline"},
                          {"count", std::size_t{3}},
                          {"flag", true},
                          {"number", 0.1},
                          {"list", JsonList{JsonObject{{"x", 1}}, JsonObject{}}},
                          {"empty", JsonList{}}};
  const auto read = nlohmann::json::parse(json_text(object));
  EXPECT_EQ(read["text"], "a \"quoted\"\nline");
  EXPECT_EQ(read["count"], 3);
  EXPECT_EQ(read["flag"], true);
  EXPECT_EQ(read["number"].get<double>(), 0.1);
  EXPECT_EQ(read["list"].size(), 2U);
  EXPECT_TRUE(read["empty"].is_array());
}

TEST(CliJsonOutput, FloatsHaveNoMoreDigitsThanTheyKnow) {
  EXPECT_EQ(json_text(Json(0.1F)), "0.1\n");
  EXPECT_EQ(json_text(Json(renderer::Vec3f{0.2F, -3, 1e-8F})), "[0.2, -3.0, 1e-08]\n");
}

TEST(CliJsonOutput, NumbersThatAreNotFiniteAreNull) {
  EXPECT_EQ(json_text(Json(std::numeric_limits<double>::quiet_NaN())), "null\n");
  EXPECT_EQ(json_text(Json(std::numeric_limits<float>::infinity())), "null\n");
}

TEST(CliJsonOutput, WhatIsNotKnownIsNull) {
  EXPECT_EQ(json_text(Json(std::optional<double>())), "null\n");
  EXPECT_EQ(json_text(Json(std::optional<double>(0.5))), "0.5\n");
}

TEST(CliJsonOutput, KeysStayInOrder) {
  EXPECT_EQ(json_text(JsonObject{{"b", 1}, {"a", 2}}), "{\n  \"b\": 1,\n  \"a\": 2\n}\n");
}

TEST(CliJsonOutput, InvalidUtf8DoesNotThrow) {
  EXPECT_TRUE(nlohmann::json::parse(json_text(Json(std::string("a\xff")))).is_string());
}

// JSON asks for ASCII's control characters alone to be escaped.
TEST(CliJsonOutput, TerminalsObeyNothingInIt) {
  const std::string name = "a\x1b\x7f\xc2\x9b\xe2\x80\xae z";
  const std::string text = json_text(Json(name));
  EXPECT_EQ(text, "\"a\\u001b\\u007f\\u009b\\u202e z\"\n");
  EXPECT_EQ(nlohmann::json::parse(text).get<std::string>(), name);
}

TEST(CliJsonOutput, SecondsAreTakenOutAtAnyDepth) {
  const JsonObject object{{"seconds", 1.5},
                          {"stages", JsonList{JsonObject{{"name", "nnls"}, {"seconds", JsonObject{{"total", 2}}}}}}};
  EXPECT_EQ(json_text(without_seconds(object)),
            json_text(JsonObject{{"stages", JsonList{JsonObject{{"name", "nnls"}}}}}));
}

}  // namespace
}  // namespace chiaro::cli
