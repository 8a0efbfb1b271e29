// Against pictures of other encoders, and what is wrong with their headers.

#include <sys/resource.h>

#include <gtest/gtest.h>

#include <array>

#include "renderer/image/decode_avif.h"
#include "renderer/image/image_file.h"
#include "renderer/image/texture.h"
#include "tests/support/error_of.h"
#include "tests/support/from_base64.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

using test::error_of;
using test::from_base64;

// 8 x 16 texels, the upper half red, the lower half black; base64, as nothing here writes AVIF.
constexpr std::string_view kAvif =
    "AAAAIGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZk1BMUEAAADybWV0YQAAAAAAAAAoaGRscgAAAAAAAAAAcGljdAAAAAAAAAAAAAAAAGxpYmF2aWYA"
    "AAAADnBpdG0AAAAAAAEAAAAeaWxvYwAAAABEAAABAAEAAAABAAABGgAAACoAAAAoaWluZgAAAAAAAQAAABppbmZlAgAAAAABAABhdjAxQ29sb3IA"
    "AAAAamlwcnAAAABLaXBjbwAAABRpc3BlAAAAAAAAAAgAAAAQAAAAEHBpeGkAAAAAAwgICAAAAAxhdjFDgSAAAAAAABNjb2xybmNseAABAA0AAIAA"
    "AAAXaXBtYQAAAAAAAAABAAEEAQKDBAAAADJtZGF0EgAKCDgI/7CAhoAQMhwQAACk/dZc2M/Rcfvum30KdduslxuAgo4j6vt4";

// 2 x 2 pixels of 1228 in 12 bits.
constexpr std::string_view kWideAvif =
    "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOptZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRt"
    "AAAAAAABAAAAImlsb2MAAAAAREAAAQABAAAAAAEOAAEAAAAAAAAAGAAAACNpaW5mAAAAAAABAAAAFWluZmUCAAAAAAEAAGF2MDEAAAAAamlw"
    "cnAAAABLaXBjbwAAABNjb2xybmNseAACAAIABoAAAAAMYXYxQ4FAbAAAAAAUaXNwZQAAAAAAAAACAAAAAgAAABBwaXhpAAAAAAMMDAwAAAAX"
    "aXBtYQAAAAAAAAABAAEEgYIDhAAAACBtZGF0EgAKCFgANjQICBuEMgoQAAAAB8gkBCLo";

std::string with_bytes(std::string bytes, std::string_view after, std::size_t at, char value) {
  bytes[bytes.find(after) + after.size() + at] = value;
  return bytes;
}

TEST(DecodeAvif, ATextureIsReadFromMemoryAndTruncatedOnesAreRefused) {
  const std::string whole = from_base64(kAvif);
  const Texture texture = decode_texture(whole, "t");
  ASSERT_EQ(texture.width, 8);
  ASSERT_EQ(texture.height, 16);
  EXPECT_GT(texture.rgba[0], 200);
  EXPECT_LT(texture.rgba[4 * 8 * 15], 50);
  EXPECT_EQ(texture.rgba[3], 255);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const std::string message = error_of([&] { decode_texture(whole.substr(0, size), "images[7]"); });
    EXPECT_EQ(message.rfind("images[7]", 0), 0U) << size << " of " << whole.size() << ": " << message;
  }
}

// Its pixels are as many as before.
TEST(DecodeAvif, AHeaderOfAnotherSizeIsRefused) {
  const test::TemporaryFolder folder;
  for (const std::size_t digit : {7, 11}) {
    for (const char size : {4, 64}) {
      const std::string other = with_bytes(from_base64(kAvif), "ispe", digit, size);
      EXPECT_NE(error_of([&] { decode_texture(other, "t"); }).find("another size than it says"), std::string::npos);
      EXPECT_NE(error_of([&] { load_image(folder.write("t.avif", other)); }).find("another size than it says"),
                std::string::npos);
    }
  }
}

// The one of 12 bits, whose coded frame says that it has 32768 x 32768 pixels.
constexpr std::string_view kHugeFrame =
    "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOptZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRt"
    "AAAAAAABAAAAImlsb2MAAAAAREAAAQABAAAAAAEOAAEAAAAAAAAAHAAAACNpaW5mAAAAAAABAAAAFWluZmUCAAAAAAEAAGF2MDEAAAAAamlw"
    "cnAAAABLaXBjbwAAABNjb2xybmNseAACAAIABoAAAAAMYXYxQ4FAbAAAAAAUaXNwZQAAAAAAAAACAAAAAgAAABBwaXhpAAAAAAMMDAwAAAAX"
    "aXBtYQAAAAAAAAABAAEEgYIDhAAAACRtZGF0EgAKDFg/3//f/9jQICBuEDIKEAAAAAfIJAQi6A==";

long kilobytes_at_most() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(DecodeAvif, AHugeFrameIsRefusedBeforeMemoryIsTakenForIt) {
  const long before = kilobytes_at_most();
  EXPECT_NE(error_of([] { decode_texture(from_base64(kHugeFrame), "t"); }).find("cannot be decoded"),
            std::string::npos);
  EXPECT_LT(kilobytes_at_most() - before, 500'000);
}

// 128 x 64 pixels in two pieces.
constexpr std::string_view kPieces =
    "AAAAIGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZk1BMUEAAAF/bWV0YQAAAAAAAAAoaGRscgAAAAAAAAAAcGljdAAAAAAAAAAAAAAAAGxpYmF2aWYA"
    "AAAADnBpdG0AAAAAAAEAAAA6aWxvYwAAAABEAAADAAEAAAABAAABpwAAAAgAAgAAAAEAAAGvAAAAJwADAAAAAQAAAdYAAAAnAAAAXGlpbmYAAAAA"
    "AAMAAAAaaW5mZQIAAAAAAQAAZ3JpZENvbG9yAAAAABppbmZlAgAAAQACAABhdjAxQ29sb3IAAAAAGmluZmUCAAABAAMAAGF2MDFDb2xvcgAAAAAc"
    "aXJlZgAAAAAAAAAQZGltZwABAAIAAgADAAAAi2lwcnAAAABfaXBjbwAAABRpc3BlAAAAAAAAAIAAAABAAAAAEHBpeGkAAAAAAwgICAAAABNjb2xy"
    "bmNseAABAA0AAIAAAAAUaXNwZQAAAAAAAABAAAAAQAAAAAxhdjFDgSAAAAAAACRpcG1hAAAAAAAAAAMAAQMBAgMAAgQEAoUDAAMEBAKFAwAAAF5t"
    "ZGF0AAAAAQCAAEASAAoJOBV//YQENACAMhgQAAC0UbTwV41BGQHkezFfRNB4/hiiBlQSAAoJOBV//YQENACAMhgQAAC0UbTwQawBGPyN06NfYPj6"
    "YZfkBfo=";

TEST(DecodeAvif, PicturesOfPiecesAreRefused) {
  EXPECT_NE(error_of([&] { decode_texture(from_base64(kPieces), "t"); }).find("is of pieces"), std::string::npos);
}

// 16 x 8 pixels: red and green above blue and white, to be turned a quarter anticlockwise, then top for bottom.
constexpr std::string_view kTurned =
    "AAAAIGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZk1BMUEAAAEGbWV0YQAAAAAAAAAoaGRscgAAAAAAAAAAcGljdAAAAAAAAAAAAAAAAGxpYmF2aWYA"
    "AAAADnBpdG0AAAAAAAEAAAAeaWxvYwAAAABEAAABAAEAAAABAAABLgAAADwAAAAoaWluZgAAAAAAAQAAABppbmZlAgAAAAABAABhdjAxQ29sb3IA"
    "AAAAfmlwcnAAAABdaXBjbwAAABRpc3BlAAAAAAAAABAAAAAIAAAAEHBpeGkAAAAAAwgICAAAAAxhdjFDgSAAAAAAABNjb2xybmNseAABAA0AAIAA"
    "AAAJaXJvdAEAAAAJaW1pcgAAAAAZaXBtYQAAAAAAAAABAAEGAQKDBIWGAAAARG1kYXQSAAoIOAy/sICGgBAyLhAAALb8Moo78nXijwp24LxmL7WG"
    "nOI+Z+HxhoKa4ZJidsD0RoDufmcyLZ4uhsA=";

// A picture's corners: top left, top right, bottom left, bottom right.
using Corners = std::array<char, 4>;

Corners corners_of(const Image& image) {
  Corners corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    const float* const rgb = image.at(i % 2 == 0 ? 0 : image.width - 1, i < 2 ? 0 : image.height - 1);
    corners[i] = rgb[0] > 0.5F ? (rgb[1] > 0.5F ? 'w' : 'r') : rgb[1] > 0.5F ? 'g' : 'b';
  }
  return corners;
}

TEST(DecodeAvif, PicturesStandAsTheyAreToBeTurnedAndMirrored) {
  const test::TemporaryFolder folder;
  Corners turned{'r', 'g', 'b', 'w'};
  for (int quarters = 0; quarters < 4; ++quarters) {
    const Corners mirrored[] = {{turned[2], turned[3], turned[0], turned[1]},
                                {turned[1], turned[0], turned[3], turned[2]}};
    for (const int mode : {0, 1}) {
      const std::string file =
          with_bytes(with_bytes(from_base64(kTurned), "irot", 0, char(quarters)), "imir", 0, char(mode));
      const auto path = folder.write("t.avif", file);
      const ImageFile picture = load_image(path);
      EXPECT_EQ(picture.image.width, quarters % 2 == 0 ? 16 : 8);
      EXPECT_EQ(load_image_header(path).image.width, picture.image.width);
      EXPECT_EQ(corners_of(picture.image), mirrored[mode]) << quarters << ' ' << mode;
    }
    turned = {turned[1], turned[3], turned[0], turned[2]};  // anticlockwise: what was right is above
  }
  EXPECT_NE(error_of([] { decode_texture(from_base64(kTurned), "t"); }).find("turned or mirrored"), std::string::npos);
}

// As older programs write them.
TEST(DecodeAvif, BitsNeedNotBeSaidTwice) {
  std::string bytes = from_base64(kAvif);
  bytes.replace(bytes.find("pixi"), 4, "free");
  EXPECT_EQ(decode_texture(bytes, "t").rgba, decode_texture(from_base64(kAvif), "t").rgba);
}

TEST(DecodeAvif, TwelveBitsAreKept) {
  const test::TemporaryFolder folder;
  const ImageFile file = load_image(folder.write("t.avif", from_base64(kWideAvif)));
  ASSERT_EQ(file.image.pixels.size(), 12U);
  for (const float value : file.image.pixels) EXPECT_NEAR(value, 1228.0 / 4095, 1e-5);
  EXPECT_EQ(decode_texture(from_base64(kWideAvif), "t").wide_rgba.size(), 16U);
}

// ITU-T H.273: 8 is linear, 16 is PQ, 18 is HLG; textures have the curve that their material says.
TEST(DecodeAvif, ACurveThatIsNotOfCommonDisplaysIsRefusedInPictures) {
  const test::TemporaryFolder folder;
  for (const auto& [code, name] : {std::pair(8, "linear"), {16, "PQ"}, {18, "HLG"}}) {
    const std::string other = with_bytes(from_base64(kAvif), "nclx", 3, char(code));
    EXPECT_NE(error_of([&] { load_image(folder.write("t.avif", other)); }).find(name), std::string::npos);
    EXPECT_EQ(decode_texture(other, "t").width, 8);
  }
}

}  // namespace
}  // namespace chiaro::renderer
