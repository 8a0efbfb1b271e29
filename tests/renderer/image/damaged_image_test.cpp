// Damage never brings in another picture, nor half of one.

#include <gtest/gtest.h>

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

INSTANTIATE_TEST_SUITE_P(Formats, CutImage, testing::Values(".exr", ".png", ".jpg"), test::kByText);

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

// OpenImageIO's reader of FITS reads a file of the name that it is given, even where there are bytes to read.
TEST(DamagedImage, NoFileTakesThePlaceOfATextureInMemory) {
  const test::WorkingFolder folder;
  for (const char* name : {"images[0]", "texture.jpg", "texture.bmp", "texture.dds", "texture"})
    folder.write(name, fits());
  ASSERT_EQ(load_image("texture.jpg").image.width, 8);
  const std::string bmp = std::string("BM") + std::string(12, '\0') + '(' + std::string(200, '\0');
  for (const std::string& damaged : {std::string("\xff\xd8\xff\xd9"), bmp, "DDS " + std::string(200, '\0')}) {
    const std::string message = error_of([&] { decode_texture(damaged, "images[0]"); });
    EXPECT_EQ(message.rfind("images[0]: cannot be decoded", 0), 0U) << damaged.substr(0, 4) << ": " << message;
  }
}

// Names with a question mark are read through a name of the library's own.
TEST(DamagedImage, NoFileTakesThePlaceOfAnother) {
  const test::WorkingFolder folder;
  for (const char* extension : {".exr", ".hdr", ".tif", ".dds"}) {
    folder.write(std::string("image") + extension, fits());
    const std::string name = std::string("a?b") + extension,
                      message = error_of([&] { load_image(folder.write(name, std::string(200, 'x'))); });
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_EQ(message.find("/dev/"), std::string::npos) << message;
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

}  // namespace
}  // namespace chiaro::renderer
