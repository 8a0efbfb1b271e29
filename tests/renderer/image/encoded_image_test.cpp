#include "renderer/image/encoded_image.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

TEST(EncodedImage, APictureOfOneColorMayBeTiny) { EXPECT_TRUE(may_hold(60, 4UL * 8192 * 8192)); }

TEST(EncodedImage, AGigabyteIsNotInAKilobyte) {
  EXPECT_FALSE(may_hold(1000, 1UL << 30));
  EXPECT_TRUE(may_hold(200'000, 1UL << 30));
}

}  // namespace
}  // namespace chiaro::renderer
