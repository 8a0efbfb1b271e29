#include "renderer/image/encoded_image.h"

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

TEST(EncodedImage, APictureOfOneColorMayBeTiny) { EXPECT_TRUE(may_hold(60, 4UL * 8192 * 8192)); }

TEST(EncodedImage, AGigabyteIsNotInAKilobyte) {
  EXPECT_FALSE(may_hold(1000, 1UL << 30));
  EXPECT_TRUE(may_hold(200'000, 1UL << 30));
}

std::string bmp_of_header(char size) {
  return std::string("BM") + std::string(12, '\0') + size + std::string(200, '\0');
}

// OpenImageIO takes what it does not know for read, and its size for whatever memory had.
TEST(EncodedImage, ABmpHasAHeaderOfAKindThatThereIs) {
  for (const int size : {12, 40, 52, 56, 108, 124}) EXPECT_FALSE(find_damage(bmp_of_header(char(size)))) << size;
  for (const int size : {0, 11, 16, 41, 64, 128})
    EXPECT_EQ(find_damage(bmp_of_header(char(size))), "is corrupt") << size;
  EXPECT_EQ(find_damage(bmp_of_header(40).substr(0, 17)), "is truncated");
  EXPECT_FALSE(find_damage(bmp_of_header(40).substr(0, 18)));
}

}  // namespace
}  // namespace chiaro::renderer
