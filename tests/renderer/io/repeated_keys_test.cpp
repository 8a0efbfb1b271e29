#include "renderer/io/repeated_keys.h"

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "renderer/io/light_file.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

TEST(RepeatedKeys, AreRefusedWithinOneObjectOnly) {
  for (const char* text :
       {R"({"a":1,"b":{"a":2},"c":[{"a":3},{"a":4}]})", R"(["a","a"])", "{}", "", "{\"a\":1,", "]"}) {
    EXPECT_NO_THROW(refuse_repeated_keys(text, "f.json")) << text;
  }
  for (const char* text : {R"({"a":1,"a":1})", R"([{"b":[{"a":{},"a":[]}]}])", R"({"a":1,"\u0061":2})"}) {
    EXPECT_EQ(test::error_of([&] { refuse_repeated_keys(text, "f.json"); }),
              "f.json: a: is there twice in one object (expected once)")
        << text;
  }
  EXPECT_THROW(refuse_repeated_keys(R"({"":1,"":2})", "f.json"), Error);
}

TEST(RepeatedKeys, OfALightAreNotWhatTheLastOneSays) {
  const test::TemporaryFolder folder;
  const auto file =
      folder.write("lights.json", R"({"lights":[{"position":[0,2,0],"intensity":[100,100,100],"intensity":[1,1,1]}]})");
  EXPECT_NE(test::error_of([&] { load_lights(file); }).find("intensity: is there twice"), std::string::npos);
}

}  // namespace
}  // namespace chiaro::renderer
