#include "renderer/io/json_text.h"

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "renderer/io/light_file.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

TEST(JsonText, RepeatedKeysAreRefusedWithinOneObjectOnly) {
  for (const char* text :
       {R"({"a":1,"b":{"a":2},"c":[{"a":3},{"a":4}]})", R"(["a","a"])", "{}", "", "{\"a\":1,", "]"}) {
    EXPECT_NO_THROW(check_json_text(text, "f.json")) << text;
  }
  for (const char* text : {R"({"a":1,"a":1})", R"([{"b":[{"a":{},"a":[]}]}])", R"({"a":1,"\u0061":2})"}) {
    EXPECT_EQ(test::error_of([&] { check_json_text(text, "f.json"); }),
              "f.json: a: is there twice in one object (expected once)")
        << text;
  }
  EXPECT_THROW(check_json_text(R"({"":1,"":2})", "f.json"), Error);
}

TEST(JsonText, RepeatedKeysOfALightAreNotWhatTheLastOneSays) {
  const test::TemporaryFolder folder;
  const auto file =
      folder.write("lights.json", R"({"lights":[{"position":[0,2,0],"intensity":[100,100,100],"intensity":[1,1,1]}]})");
  EXPECT_NE(test::error_of([&] { load_lights(file); }).find("intensity: is there twice"), std::string::npos);
}

// Exporters fill chunks of GLBs with them.
TEST(JsonText, NothingIsBehindANulButFilling) {
  EXPECT_NO_THROW(check_json_text(std::string("{}\0\0 \0", 6), "f.json"));
  EXPECT_EQ(test::error_of([] { check_json_text(std::string("{}\0{", 4), "f.json"); }),
            "f.json: JSON: goes on behind a NUL at byte 2 (expected text)");
}

}  // namespace
}  // namespace chiaro::renderer
