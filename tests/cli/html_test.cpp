#include "cli/html.h"

#include <gtest/gtest.h>

namespace chiaro::cli {
namespace {

TEST(Html, HoldsNoMarkupOfNames) {
  EXPECT_EQ(html_escaped("<script>alert('x & \"y\"')</script>"),
            "&lt;script&gt;alert(&#39;x &amp; &quot;y&quot;&#39;)&lt;/script&gt;");
  EXPECT_EQ(html_escaped("Küche\n1"), "Küche\n1");
  EXPECT_EQ(html_escaped(std::string_view("a\0b\x1b", 4)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD");
}

// RFC 4648, section 10.
TEST(Html, EncodesBase64) {
  const std::string head = "data:image/png;base64,";
  EXPECT_EQ(png_data_uri(""), head);
  EXPECT_EQ(png_data_uri("f"), head + "Zg==");
  EXPECT_EQ(png_data_uri("fo"), head + "Zm8=");
  EXPECT_EQ(png_data_uri("foo"), head + "Zm9v");
  EXPECT_EQ(png_data_uri("foobar"), head + "Zm9vYmFy");
  EXPECT_EQ(png_data_uri("\xff\xfe\xfd"), head + "//79");
}

TEST(Html, FillsInPartsOnce) {
  const auto part = [](std::string_view name) { return name == "a" ? std::string("{{b}}") : std::string("2"); };
  EXPECT_EQ(fill_in("<{{a}}, {{b}}>", part), "<{{b}}, 2>");
}

}  // namespace
}  // namespace chiaro::cli
