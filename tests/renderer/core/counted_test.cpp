#include "renderer/core/counted.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

TEST(Counted, OneIsSingular) {
  EXPECT_EQ(counted(1, "pixel is", "pixels are"), "1 pixel is");
  EXPECT_EQ(counted(2, "pixel is", "pixels are"), "2 pixels are");
  EXPECT_EQ(counted(0, "pixel is", "pixels are"), "0 pixels are");
}

}  // namespace
}  // namespace chiaro::renderer
