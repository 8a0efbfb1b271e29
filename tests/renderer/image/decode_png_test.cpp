#include "renderer/image/decode_png.h"

#include <gtest/gtest.h>
#include <bit>
#include <cstring>

#include "renderer/core/atomic_file.h"
#include "renderer/image/image_file.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

std::string big_endian(std::size_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += char(number >> shift & 0xFF);
  return bytes;
}

// With the checksum that belongs to it (ISO/IEC 15948:2004, annex D).
std::string chunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : type + data) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xEDB88320U ^ (crc >> 1) : crc >> 1;
  }
  return big_endian(data.size()) + type + data + big_endian(~crc);
}

std::string header(int width, int height, int depth, int color, int interlaced = 0) {
  return chunk("IHDR", big_endian(std::size_t(width)) + big_endian(std::size_t(height)) + char(depth) + char(color) +
                           std::string(2, 0) + char(interlaced));
}

const std::string kSignature = "\x89PNG\r\n\x1a\n", kEnd = chunk("IEND", "");

// Deflated without compression, as RFC 1950 and 1951 have it.
std::string pixels(const std::string& rows) {
  std::uint32_t a = 1, b = 0;
  for (const char byte : rows) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  const auto low = char(rows.size() & 0xFF), high = char(rows.size() >> 8);
  return chunk("IDAT", std::string("\x78\x01\x01") + low + high + char(~low) + char(~high) + rows +
                           big_endian(std::size_t{b} << 16 | a));
}

std::string png(const std::string& before_end) { return kSignature + before_end + kEnd; }

// 2 x 2 pixels of RGB.
const std::string kHeader = header(2, 2, 8, 2), kPixels = pixels(std::string(14, 0));

struct Fault {
  const char* name;
  std::string file, problem;
};

class DamagedPng : public testing::TestWithParam<Fault> {};

// libpng's own line on standard error would be a second one.
TEST_P(DamagedPng, IsAnErrorAndNothingOnStandardError) {
  const TemporaryFolder folder;
  const auto path = folder.write("picture.png", GetParam().file);
  testing::internal::CaptureStderr();
  const std::string of_image = error_of([&] { load_image(path); });
  const std::string of_texture = error_of([&] { decode_texture(GetParam().file, "images[7]"); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(of_image, path.string() + ": " + GetParam().problem + " (expected a whole PNG)");
  EXPECT_EQ(of_texture, "images[7]: " + GetParam().problem + " (expected a whole PNG)");
}

INSTANTIATE_TEST_SUITE_P(
    Content, DamagedPng,
    testing::Values(
        Fault{"too_few_pixels", png(kHeader + pixels(std::string(9, 0))), "is corrupt: Not enough image data"},
        Fault{"no_such_filter", png(kHeader + pixels(std::string(14, 7))), "is corrupt: bad adaptive filter value"},
        Fault{"not_compressed", png(kHeader + chunk("IDAT", "abcdefgh")), "is corrupt: IDAT: incorrect header check"},
        Fault{"depth", png(header(2, 2, 3, 2) + kPixels), "is corrupt: Invalid IHDR data"},
        Fault{"two_headers", png(kHeader + kHeader + kPixels), "is corrupt: IHDR: out of place"},
        Fault{"no_pixels", png(kHeader), "is corrupt: IEND: out of place"},
        Fault{"no_palette", png(header(2, 2, 8, 3) + kPixels), "is corrupt: IDAT: Missing PLTE before IDAT"},
        Fault{"beyond_palette", png(header(2, 1, 2, 3) + chunk("PLTE", "abc012xyz") + pixels(std::string("\0\xc0", 2))),
              "is corrupt: colour 3 of a palette of 3"},
        Fault{"unknown_chunk", png(kHeader + chunk("ABCD", "") + kPixels),
              "is corrupt: ABCD: unhandled critical chunk"},
        Fault{"no_end", kSignature + kHeader + kPixels, "is truncated"}),
    test::kByName);

// As glTF textures and as pictures have them: samples of 16 bits, palettes with transparency, less than a byte.
TEST(DecodePng, SamplesOfEveryKindAreWhatOpenImageIoMakesOfThem) {
  const TemporaryFolder folder;
  using Bytes = std::vector<std::uint8_t>;
  const std::string wide = png(header(3, 1, 16, 0) + pixels(std::string("\0\x01\x02\x80\0\xff\xff", 7)));
  EXPECT_EQ(decode_texture(wide, "t").wide_rgba,
            (std::vector<std::uint16_t>{258, 258, 258, 65535, 32768, 32768, 32768, 65535, 65535, 65535, 65535, 65535}));
  EXPECT_TRUE(decode_texture(wide, "t").rgba.empty());
  const std::string needlessly_wide = png(header(2, 1, 16, 0) + pixels(std::string("\0\x07\x07\xff\xff", 5)));
  EXPECT_EQ(decode_texture(needlessly_wide, "t").rgba, (Bytes{7, 7, 7, 255, 255, 255, 255, 255}));
  EXPECT_EQ(load_image(folder.write("wide.png", wide)).image.pixels,
            (std::vector<float>{258 * (1 / 65535.0F), 32768 * (1 / 65535.0F), 1}));
  const std::string palette = png(header(2, 1, 2, 3) + chunk("PLTE", "abc012xyz") +
                                  chunk("tRNS", std::string("\x01\x02", 2)) + pixels(std::string("\0\x60", 2)));
  EXPECT_EQ(decode_texture(palette, "t").rgba, (Bytes{'0', '1', '2', 2, 'x', 'y', 'z', 255}));
  const std::string interlaced =
      png(header(3, 2, 1, 0, 1) + pixels(std::string("\0\x80\0\0\0\x80\0\x40", 8)));  // 1 1 0, 0 1 0
  const Image image = load_image(folder.write("interlaced.exr", interlaced)).image;
  EXPECT_EQ(image.channel_names, std::vector<std::string>{"Y"});
  EXPECT_EQ(image.pixels, (std::vector<float>{1, 1, 0, 0, 1, 0})) << "whatever the file is called";
}

// ITU-T H.273: 13 is sRGB, 8 is linear, 16 is PQ, 18 is HLG; textures have the curve that their material says.
TEST(DecodePng, ACurveThatIsNotOfCommonDisplaysIsRefusedInPictures) {
  const TemporaryFolder folder;
  const auto with_curve = [](char curve) {
    return png(kHeader + chunk("cICP", std::string("\x01") + curve + std::string("\0\1", 2)) + kPixels);
  };
  EXPECT_EQ(load_image(folder.write("t.png", with_curve(13))).image.width, 2);
  for (const auto& [code, name] : {std::pair(8, "linear"), {16, "PQ"}, {18, "HLG"}}) {
    const std::string message = error_of([&] { load_image(folder.write("t.png", with_curve(char(code)))); });
    EXPECT_NE(message.find(std::string("colours: have the curve \"") + name), std::string::npos) << message;
    EXPECT_EQ(decode_texture(with_curve(char(code)), "t").width, 2);
  }
}

TEST(DecodePng, AttributesComeAlong) {
  const TemporaryFolder folder;
  const std::string text = chunk("tEXt", std::string("Author\0somebody", 15));
  const ImageFile file = load_image_header(folder.write("picture.png", png(kHeader + text + kPixels)));
  EXPECT_EQ(file.image.width, 2);
  EXPECT_TRUE(file.whole_numbers);
  EXPECT_TRUE(std::any_of(file.attributes.begin(), file.attributes.end(),
                          [](const auto& a) { return a.second == AttributeValue(std::string("somebody")); }));
}

}  // namespace
}  // namespace chiaro::renderer::tests
