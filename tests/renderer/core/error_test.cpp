#include "renderer/core/error.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

TEST(CoreError, NamesItsFileItsPlaceWhatIsWrongAndWhatWasExpected) {
  EXPECT_STREQ(Error({"a.glb", "nodes[1]", "is odd", "even"}).what(), "a.glb: nodes[1]: is odd (expected even)");
  EXPECT_STREQ(Error({"", "nodes[1]", "is odd", ""}).what(), "nodes[1]: is odd");
}

TEST(CoreError, IsToldToItsEndWhateverNamesHaveInThem) {
  const std::string name("la\0mp", 5);
  EXPECT_STREQ(Error({"a.glb", "", "no node " + name, "a name"}).what(), "a.glb: no node la mp (expected a name)");
}

}  // namespace
}  // namespace chiaro::renderer
