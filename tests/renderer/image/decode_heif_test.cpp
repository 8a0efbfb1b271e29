// Against pictures of other encoders, and what is wrong with their headers.

#include <sys/resource.h>

#include <gtest/gtest.h>

#include "renderer/image/decode_heif.h"
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
    "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAASttZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAA"
    "AA5waXRtAAAAAAABAAAANGlsb2MAAAAAREAAAgABAAAAAAFPAAEAAAAAAAAAJAACAAAAAAFzAAEAAAAAAAABFAAAADhpaW5mAAAA"
    "AAACAAAAFWluZmUCAAAAAAEAAGF2MDEAAAAAFWluZmUCAAABAAIAAEV4aWYAAAAAamlwcnAAAABLaXBjbwAAABNjb2xybmNseAAC"
    "AAIABoAAAAAMYXYxQ4EADAAAAAAUaXNwZQAAAAAAAAAIAAAAEAAAABBwaXhpAAAAAAMICAgAAAAXaXBtYQAAAAAAAAABAAEEgYID"
    "hAAAABppcmVmAAAAAAAAAA5jZHNjAAIAAQABAAABQG1kYXQSAAoIGAj/sECAgaEyFhgACiiihQBIYtJLSwsgk2IZXynLcjQAAAEM"
    "RXhpZgAATU0qAAAAALZvaWlvdG9vbCAtLWNyZWF0ZSA4eDE2IDMgLS1maWxsOmNvbG9yPTEsMCwwIDh4OCAtZCB1aW50OCAtbyAv"
    "dG1wL2dlb190LmF2aWYAT3BlbkltYWdlSU8gMi40LjcuMSA6IG9paW90b29sIC0tY3JlYXRlIDh4MTYgMyAtLWZpbGw6Y29sb3I9"
    "MSwwLDAgOHg4IC1kIHVpbnQ4IC1vIC90bXAvZ2VvX3QuYXZpZgAAAgExAAIAAABiAAAAVIdpAAQAAAABAAAA1AAAAAAABJAAAAcA"
    "AAAEMDIzMJEBAAcAAAAEAQIDAJITAAIAAABMAAAACKAAAAcAAAAEMDEwMAAAAAA=";

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

TEST(DecodeHeif, ATextureIsReadFromMemoryAndTruncatedOnesAreRefused) {
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
TEST(DecodeHeif, AHeaderOfAnotherSizeIsRefused) {
  const test::TemporaryFolder folder;
  for (const std::size_t digit : {7, 11}) {
    for (const char size : {4, 64}) {
      const std::string other = with_bytes(from_base64(kAvif), "ispe", digit, size);
      EXPECT_NE(error_of([&] { decode_texture(other, "t"); }).find("contradicts itself"), std::string::npos);
      EXPECT_NE(error_of([&] { load_image(folder.write("t.avif", other)); }).find("contradicts itself"),
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

TEST(DecodeHeif, AHugeFrameIsRefusedBeforeMemoryIsTakenForIt) {
  const long before = kilobytes_at_most();
  EXPECT_NE(error_of([] { decode_texture(from_base64(kHugeFrame), "t"); }).find("cannot be decoded"),
            std::string::npos);
  EXPECT_LT(kilobytes_at_most() - before, 500'000);
}

// The entry of its only picture says so.
TEST(DecodeHeif, PicturesOfPiecesAreRefused) {
  for (const std::string type : {"grid", "iovl", "iden"}) {
    std::string bytes = from_base64(kAvif);
    bytes.replace(bytes.find("av01"), 4, type);
    EXPECT_NE(error_of([&] { decode_texture(bytes, "t"); }).find("is put together of pieces"), std::string::npos);
  }
}

TEST(DecodeHeif, TwelveBitsAreKept) {
  const test::TemporaryFolder folder;
  const ImageFile file = load_image(folder.write("t.avif", from_base64(kWideAvif)));
  ASSERT_EQ(file.image.pixels.size(), 12U);
  for (const float value : file.image.pixels) EXPECT_NEAR(value, 1228.0 / 4095, 1e-5);
  EXPECT_EQ(decode_texture(from_base64(kWideAvif), "t").wide_rgba.size(), 16U);
}

// ITU-T H.273: 8 is linear, 16 is PQ, 18 is HLG; textures have the curve that their material says.
TEST(DecodeHeif, ACurveThatIsNotOfCommonDisplaysIsRefusedInPictures) {
  const test::TemporaryFolder folder;
  for (const auto& [code, name] : {std::pair(8, "linear"), {16, "PQ"}, {18, "HLG"}}) {
    const std::string other = with_bytes(from_base64(kAvif), "nclx", 3, char(code));
    EXPECT_NE(error_of([&] { load_image(folder.write("t.avif", other)); }).find(name), std::string::npos);
    EXPECT_EQ(decode_texture(other, "t").width, 8);
  }
}

}  // namespace
}  // namespace chiaro::renderer
