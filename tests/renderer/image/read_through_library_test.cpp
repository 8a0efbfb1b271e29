#include "renderer/image/read_through_library.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/error_of.h"

namespace chiaro::renderer {
namespace {

// What is thrown comes out as an Error with this message.
template <class Thrown>
std::string message_of(const Thrown& thrown) {
  return test::error_of([&] { read_through_library("picture.png", [&]() -> int { throw thrown; }); });
}

TEST(ReadThroughLibrary, WhateverIsThrownNamesTheFile) {
  EXPECT_EQ(message_of(std::runtime_error("no such block")),
            "picture.png: cannot be decoded: no such block (expected a whole image)");
  EXPECT_EQ(message_of(std::bad_alloc()),
            "picture.png: takes more memory than there is (expected an image of a sensible size)");
  EXPECT_EQ(message_of(Error({"other.png", "header", "is wrong", "a right one"})),
            "other.png: header: is wrong (expected a right one)");
  EXPECT_EQ(read_through_library("picture.png", [] { return 7; }), 7);
}

TEST(ReadThroughLibrary, WhatIsNoFileIsNotRead) {
  EXPECT_EQ(test::error_of([] { require_file("/not there", "an image"); }),
            "/not there: no such file (expected an existing file)");
  EXPECT_EQ(test::error_of([] { require_file("/dev/null", "an image"); }),
            "/dev/null: is not a file (expected an image)");
}

}  // namespace
}  // namespace chiaro::renderer
