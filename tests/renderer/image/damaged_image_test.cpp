// Damage never brings in another picture, nor half of one.

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <vector>

#include "renderer/core/atomic_file.h"
#include "renderer/image/image_file.h"
#include "tests/support/error_of.h"
#include "tests/support/test_names.h"
#include "tests/support/working_folder.h"

namespace chiaro::renderer {
namespace {

using test::error_of;

Image busy_image() {
  Image image = make_image(64, 64, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i * i % 251) / 251;
  return image;
}

class CutImage : public testing::TestWithParam<const char*> {};

TEST_P(CutImage, IsRefusedWhereverItIsCut) {
  const test::TemporaryFolder folder;
  const auto path = folder / (std::string("whole") + GetParam());
  save_image(busy_image(), path, std::string(GetParam()) == ".exr" ? PixelType::kHalf : PixelType::kUint8);
  const std::string whole = read_file(path);
  for (const double fraction : {0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98}) {
    const auto cut =
        folder.write(std::string("cut") + GetParam(), whole.substr(0, std::size_t(fraction * double(whole.size()))));
    const std::string message = error_of([&] { load_image(cut); });
    EXPECT_NE(message.find("cut"), std::string::npos) << fraction;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, CutImage, testing::Values(".exr", ".png", ".jpg", ".tif", ".webp", ".hdr"),
                         test::kByText);

// NASA, Definition of the Flexible Image Transport System: 8 x 8 samples.
std::string fits() {
  std::string header;
  for (const char* card :
       {"SIMPLE  =                    T", "BITPIX  =                    8", "NAXIS   =                    2",
        "NAXIS1  =                    8", "NAXIS2  =                    8", "END"}) {
    header += card;
    header.resize((header.size() + 79) / 80 * 80, ' ');
  }
  header.resize(2880, ' ');
  return header + std::string(2880, '\x7f');
}

// OpenImageIO's reader of FITS, which it tries where others have failed, reads the file of the name that it is given,
// even where there are bytes to read.
TEST(DamagedImage, NoFileTakesThePlaceOfATextureInMemory) {
  const test::WorkingFolder folder;
  for (const char* name : {"images[0]", "texture.jpg", "texture"}) folder.write(name, fits());
  const std::string message = error_of([&] { decode_texture("\xff\xd8\xff\xd9", "images[0]"); });
  EXPECT_EQ(message.rfind("images[0]: cannot be decoded", 0), 0U) << message;
}

TEST(DamagedImage, NoFileTakesThePlaceOfAnother) {
  const test::WorkingFolder folder;
  for (const char* extension : {".exr", ".hdr", ".tif", ".tga"}) {
    folder.write(std::string("image") + extension, fits());
    const std::string name = std::string("a?b") + extension;
    const std::string message = error_of([&] { load_image(folder.write(name, std::string(200, 'x'))); });
    EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

TEST(DamagedImage, ATruncatedJpegIsRefusedWhateverItsName) {
  const test::WorkingFolder folder;
  save_image(busy_image(), "whole.jpg", PixelType::kUint8);
  const std::string whole = read_file("whole.jpg");
  for (const char* name : {"picture.png", "picture.JPG", "picture"}) {
    folder.write(name, whole);
    EXPECT_EQ(load_image(name).image.width, 64) << name;
    folder.write(name, whole.substr(0, whole.size() / 2));
    EXPECT_EQ(error_of([&] { load_image(name); }), std::string(name) + ": is truncated (expected a whole image)");
  }
}

// Of 64 x 48 pixels, 8 bits each of RGB, with the directory before them, as many programs write it and we do not.
// Source: Aldus, TIFF 6.0, sections 2 and 15.
class TiffBytes {
 public:
  // Strips of that many lines, or tiles of that size, whose pixels are all 200.
  static std::string of_strips(std::uint32_t lines) { return TiffBytes(64, lines, {278, lines}, 273, 279).bytes_; }
  static std::string of_tiles(std::uint32_t size) { return TiffBytes(size, size, {323, size}, 324, 325).bytes_; }

 private:
  TiffBytes(std::uint32_t width, std::uint32_t height, std::pair<std::uint16_t, std::uint32_t> lines,
            std::uint16_t offsets_tag, std::uint16_t sizes_tag) {
    const std::uint32_t count = 64 / width * (48 / height), size = 3 * width * height;
    std::map<std::uint16_t, std::vector<std::uint32_t>> tags{
        {256, {64}}, {257, {48}}, {258, {8, 8, 8}}, {259, {1}},
        {262, {2}},  {277, {3}},  {284, {1}},       {lines.first, {lines.second}}};
    if (width < 64) tags[322] = {width};
    tags[sizes_tag].assign(count, size);
    tags[offsets_tag].resize(count);
    const std::uint32_t lists = 8 + 2 + 12 * std::uint32_t(tags.size()) + 4;
    std::uint32_t listed = 0;
    for (const auto& [tag, values] : tags) listed += values.size() > 1 ? 4 * std::uint32_t(values.size()) : 0;
    for (std::uint32_t i = 0; i < count; ++i) tags[offsets_tag][i] = lists + listed + i * size;

    bytes_ = "II*";
    bytes_ += '\0';
    number(8), number(tags.size(), 2);
    std::string list;
    for (const auto& [tag, values] : tags) {
      number(tag, 2), number(4, 2), number(values.size());
      number(values.size() > 1 ? lists + list.size() : values[0]);
      if (values.size() > 1) list += TiffBytes(values).bytes_;
    }
    number(0);
    bytes_ += list + std::string(std::size_t(count) * size, '\xc8');
  }
  explicit TiffBytes(const std::vector<std::uint32_t>& values) {
    for (const std::uint32_t value : values) number(value);
  }

  void number(std::size_t value, int bytes = 4) {
    for (int i = 0; i < bytes; ++i) bytes_ += char(value >> 8 * i & 0xff);
  }

  std::string bytes_;
};

// OpenImageIO 2.4 takes pixels that are not there for read.
TEST(DamagedImage, ATiffWithoutAllOfItsPixelsIsRefused) {
  const test::TemporaryFolder folder;
  for (const std::string& whole : {TiffBytes::of_strips(48), TiffBytes::of_strips(8), TiffBytes::of_tiles(16)}) {
    const Image image = load_image(folder.write("whole.tif", whole)).image;
    ASSERT_EQ(image.height, 48);
    for (const float value : image.pixels) ASSERT_FLOAT_EQ(value, 200.0F / 255);
    for (const std::size_t missing : {1, 700, 5000, 9000}) {
      const auto cut = folder.write("cut.tif", whole.substr(0, whole.size() - missing));
      EXPECT_NE(error_of([&] { load_image(cut); }).find("cut.tif: pixels: cannot be read"), std::string::npos)
          << missing;
    }
  }
}

// With other bytes in the place of those.
std::string replaced(std::string bytes, const std::string& before, const std::string& after) {
  const std::size_t at = bytes.find(before);
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at, before.size(), after);
}

// OpenImageIO makes nearly nothing of the first, and inverts the second's alpha, or nothing of it.
TEST(DamagedImage, ATiffOfSamplesThatOpenImageIoGetsWrongIsRefused) {
  const test::TemporaryFolder folder;
  const std::string eight("\x08\0\0\0", 4), twenty_four("\x18\0\0\0", 4), photometric("\x06\1\4\0\1\0\0\0", 8);
  const std::string whole = TiffBytes::of_strips(8);
  const auto wide =
      folder.write("wide.tif", replaced(whole, eight + eight + eight, twenty_four + twenty_four + twenty_four));
  EXPECT_NE(error_of([&] { load_image(wide); }).find("samples of 24 bits"), std::string::npos);
  const auto inverted = folder.write("inverted.tif", replaced(whole, photometric + '\2', photometric + '\0'));
  EXPECT_NE(error_of([&] { load_image(inverted); }).find("white as zero"), std::string::npos);
  const auto inks = folder.write("inks.tif", replaced(TiffBytes::of_tiles(16), photometric + '\2', photometric + '\5'));
  EXPECT_NE(error_of([&] { load_image(inks); }).find("tiles of four inks"), std::string::npos);
}

// libtiff makes something of them whatever is missing.
TEST(DamagedImage, ATiffWhoseDamageWouldNotBeToldIsRefused) {
  const test::TemporaryFolder folder;
  const std::string photometric("\x06\1\4\0\1\0\0\0", 8), compression("\x03\1\4\0\1\0\0\0", 8);
  const std::string whole = TiffBytes::of_strips(8);
  for (const auto& [code, name] : {std::pair('\6', "YCbCr"), {'\x08', "LAB"}}) {
    const auto path = folder.write("other.tif", replaced(whole, photometric + '\2', photometric + code));
    EXPECT_NE(error_of([&] { load_image(path); }).find(name), std::string::npos) << error_of([&] { load_image(path); });
  }
  const auto jpeg = folder.write("jpeg.tif", replaced(whole, compression + '\1', compression + '\7'));
  EXPECT_NE(error_of([&] { load_image(jpeg); }).find("JPEG"), std::string::npos) << error_of([&] { load_image(jpeg); });
}

// OpenImageIO would make fractions of 2³² of them.
TEST(DamagedImage, AnExrWhoseColoursAreWholeNumbersIsRefused) {
  const test::TemporaryFolder folder;
  save_image(busy_image(), folder / "float.exr", PixelType::kFloat);
  const std::string red_float("R\0\2\0\0\0", 6), red_whole("R\0\0\0\0\0", 6);
  const auto path = folder.write("whole.exr", replaced(read_file(folder / "float.exr"), red_float, red_whole));
  EXPECT_NE(error_of([&] { load_image(path); }).find("channel R: has whole numbers"), std::string::npos);
}

// OpenImageIO would make fractions of 2³² of them, of alpha and of what identifies things.
TEST(DamagedImage, OtherWholeNumbersOfAnExrAreWhatTheyAre) {
  const test::TemporaryFolder folder;
  Image image = make_image(2, 1, {"R", "G", "B", "A"});
  image.pixels = {0.5F, 0.5F, 0.5F, std::bit_cast<float>(1U), 0.5F, 0.5F, 0.5F, std::bit_cast<float>(12345U)};
  save_image(image, folder / "float.exr", PixelType::kFloat);
  const std::string alpha_float("A\0\2\0\0\0", 6), alpha_whole("A\0\0\0\0\0", 6);
  const auto path = folder.write("whole.exr", replaced(read_file(folder / "float.exr"), alpha_float, alpha_whole));
  const ImageFile read = load_image(path);
  EXPECT_EQ(read.image.pixels, (std::vector<float>{0.5F, 0.5F, 0.5F, 1, 0.5F, 0.5F, 0.5F, 12345}));
  EXPECT_FALSE(read.whole_numbers);
}

TEST(DamagedImage, AnExrWhoseColoursAreInPartsOfTheirOwnIsRefused) {
  const test::TemporaryFolder folder;
  const std::string seed = read_file(CHIARO_SOURCE_DIR "/tests/fuzz/seeds/image_file/parts_of_one_colour");
  const auto path = folder.write("parts.exr", seed.substr(1));
  EXPECT_NE(error_of([&] { load_image(path); }).find("parts: have one colour each"), std::string::npos);
}

TEST(DamagedImage, ATiffWhosePixelsCannotBeUnpackedIsRefused) {
  const test::TemporaryFolder folder;
  for (const PixelType type : {PixelType::kUint8, PixelType::kFloat}) {
    const auto path = folder / "picture.tif";
    save_image(busy_image(), path, type);
    std::string bytes = read_file(path);
    bytes.replace(bytes.size() / 2, 100, std::string(100, 'U'));
    folder.write("picture.tif", bytes);
    EXPECT_NE(error_of([&] { load_image(path); }).find("picture.tif: pixels: cannot be read"), std::string::npos);
  }
}

}  // namespace
}  // namespace chiaro::renderer
