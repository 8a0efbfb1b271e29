#include "cli/painted_picture.h"

#include <cmath>

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "renderer/image/image_file.h"
#include "tests/support/associated_tiff.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::cli {
namespace {

using renderer::Image;
using renderer::Vec3f;

class PaintedPictureTest : public testing::Test {
 protected:
  std::string save(const std::string& name, const Image& image, renderer::PixelType type,
                   const renderer::Attributes& attributes = {}) const {
    const auto path = folder_.path() / name;
    renderer::save_image(image, path, type, attributes);
    return path.string();
  }
  static PictureEncoding encoding(float exposure = 0) {
    PictureEncoding encoding;
    encoding.view.config = CHIARO_SOURCE_DIR "/scenes/color/config.ocio";
    encoding.view.view.view = "Un-tone-mapped";
    encoding.view.view.exposure = exposure;
    return encoding;
  }

  const test::TemporaryFolder folder_;
};

Image picture_of(std::vector<std::string> channels, std::vector<float> pixels) {
  Image image = renderer::make_image(int(pixels.size() / channels.size()), 1, channels);
  image.pixels = std::move(pixels);
  return image;
}

TEST_F(PaintedPictureTest, AnExrIsSceneLinear) {
  const std::string file =
      save("a.exr", picture_of({"R", "G", "B"}, {1, 2, 300, 0, 0.5F, 4}), renderer::PixelType::kFloat);
  const PaintedPicture picture = load_painted_picture(file, encoding());
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 1);
  EXPECT_EQ(picture.pixels[0], (Vec3f{1, 2, 300}));
  EXPECT_EQ(picture.white, (Vec3f{1, 1, 1}));
  EXPECT_EQ(picture.white_pixels, 0U);
}

TEST_F(PaintedPictureTest, ExposureIsUndone) {
  const std::string file = save("a.exr", picture_of({"R", "G", "B"}, {8, 16, 24}), renderer::PixelType::kFloat);
  const PaintedPicture picture = load_painted_picture(file, encoding(3));
  EXPECT_EQ(picture.pixels[0], (Vec3f{1, 2, 3}));
  EXPECT_EQ(picture.white, (Vec3f{0.125F, 0.125F, 0.125F}));
}

TEST_F(PaintedPictureTest, AlphaIsWeightAndDividedOutOfAnExr) {
  const std::string file =
      save("a.exr", picture_of({"R", "G", "B", "A"}, {1, 2, 3, 0.5F, 0, 0, 0, 0}), renderer::PixelType::kFloat);
  const PaintedPicture picture = load_painted_picture(file, encoding());
  EXPECT_EQ(picture.pixels[0], (Vec3f{2, 4, 6}));
  EXPECT_EQ(picture.weight, (std::vector<float>{0.5F, 0}));
}

TEST_F(PaintedPictureTest, AlphaIsDividedOutBeforeANamedSpaceIsConvertedFrom) {
  const std::string file =
      save("a.exr", picture_of({"R", "G", "B", "A"}, {0.25F, 0.25F, 0.25F, 0.5F}), renderer::PixelType::kFloat);
  PictureEncoding encoded = encoding();
  encoded.space = "scene_linear";
  EXPECT_NEAR(load_painted_picture(file, encoded).pixels[0].x, 0.5F, 1e-5F);
  encoded.space = "sRGB - Texture";
  EXPECT_NEAR(load_painted_picture(file, encoded).pixels[0].x, 0.21404F, 1e-4F);
}

TEST_F(PaintedPictureTest, AlphaIsDividedOutOfFilesThatSaySoAlone) {
  const std::string file =
      save("a.tif", picture_of({"R", "G", "B", "A"}, {0.5F, 0.5F, 0.5F, 0.5F}), renderer::PixelType::kFloat);
  EXPECT_EQ(load_painted_picture(file, encoding()).pixels[0], (Vec3f{0.5F, 0.5F, 0.5F}));
  test::set_associated_alpha(file);
  EXPECT_EQ(load_painted_picture(file, encoding()).pixels[0], (Vec3f{1, 1, 1}));
}

// Two thirds and white, at an alpha of 0.6.
TEST_F(PaintedPictureTest, WholeNumbersAreDividedByAlphaAsTheyAreStored) {
  const float third = 1 / 3.0F;
  const std::string straight =
      save("a.png", picture_of({"R", "G", "B", "A"}, {2 * third, third, 0, 0.6F, 1, 1, 1, 0.6F}),
           renderer::PixelType::kUint8);
  const std::string multiplied =
      save("a.tif", picture_of({"R", "G", "B", "A"}, {0.4F, 0.2F, 0, 0.6F, 0.6F, 0.6F, 0.6F, 0.6F}),
           renderer::PixelType::kUint8);
  test::set_associated_alpha(multiplied);
  const PaintedPicture a = load_painted_picture(straight, encoding()), b = load_painted_picture(multiplied, encoding());
  for (std::size_t i = 0; i < 2; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.pixels[i][c], b.pixels[i][c], 1e-5F) << i;
  }
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(b.white_pixels, 1U);
}

// The colorimetric sRGB view is the sRGB curve of IEC 61966-2-1.
TEST_F(PaintedPictureTest, APngGoesBackThroughTheView) {
  const std::string file = save("a.png", picture_of({"R", "G", "B"}, {0.2F, 0.4F, 0.6F}), renderer::PixelType::kUint8);
  const PaintedPicture picture = load_painted_picture(file, encoding());
  const float values[3] = {0.2F, 0.4F, 0.6F};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixels[0][c], std::pow((values[c] + 0.055F) / 1.055F, 2.4F), 1e-3F);
  EXPECT_NEAR(picture.white.x, 1, 1e-3F);
}

TEST_F(PaintedPictureTest, WhiteOfAPngIsLeftOutUnlessItIsMeant) {
  const std::string file =
      save("a.png", picture_of({"R", "G", "B"}, {1, 0.4F, 0.6F, 0.5F, 0.5F, 0.5F}), renderer::PixelType::kUint8);
  PictureEncoding encoded = encoding();
  const PaintedPicture picture = load_painted_picture(file, encoded);
  EXPECT_EQ(picture.white_pixels, 1U);
  EXPECT_EQ(picture.weight, (std::vector<float>{0, 1}));
  encoded.keep_white = true;
  EXPECT_EQ(load_painted_picture(file, encoded).weight, (std::vector<float>{1, 1}));
}

TEST_F(PaintedPictureTest, WhiteOfAPngInANamedSpaceIsLeftOutToo) {
  const std::string file = save("a.png", picture_of({"R", "G", "B"}, {1, 0.4F, 0.6F}), renderer::PixelType::kUint8);
  const std::string floats = save("a.exr", picture_of({"R", "G", "B"}, {1, 0.4F, 0.6F}), renderer::PixelType::kFloat);
  PictureEncoding encoded = encoding();
  encoded.space = "sRGB - Texture";
  EXPECT_EQ(load_painted_picture(file, encoded).weight, (std::vector<float>{0}));
  EXPECT_EQ(load_painted_picture(floats, encoded).weight, (std::vector<float>{1}));
  encoded.keep_white = true;
  EXPECT_EQ(load_painted_picture(file, encoded).weight, (std::vector<float>{1}));
}

TEST_F(PaintedPictureTest, ANamedSpaceIsConvertedFrom) {
  const std::string file = save("a.exr", picture_of({"R", "G", "B"}, {0.5F, 0.5F, 0.5F}), renderer::PixelType::kFloat);
  PictureEncoding encoded = encoding();
  encoded.space = "sRGB - Texture";
  EXPECT_NEAR(load_painted_picture(file, encoded).pixels[0].x, 0.21404F, 1e-4F);
}

TEST_F(PaintedPictureTest, TheSpaceThatAnExrNamesIsConvertedFrom) {
  const std::string file = save("a.exr", picture_of({"R", "G", "B"}, {0.9505F, 1, 1.0888F}),
                                renderer::PixelType::kFloat, {{"chiaro:color_space", "CIE-XYZ-D65"}});
  PictureEncoding encoded = encoding();
  const PaintedPicture picture = load_painted_picture(file, encoded);
  EXPECT_EQ(picture.encoding, "in CIE-XYZ-D65");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.pixels[0][c], 1, 1e-3F);
  encoded.space = "Linear Rec.709 (sRGB)";
  EXPECT_NEAR(load_painted_picture(file, encoded).pixels[0].x, 0.9505F, 1e-4F);
}

TEST_F(PaintedPictureTest, WithoutColoursIsRefused) {
  const std::string file = save("a.exr", picture_of({"depth", "id"}, {1, 2}), renderer::PixelType::kFloat);
  EXPECT_THROW(load_painted_picture(file, encoding()), renderer::Error);
}

TEST_F(PaintedPictureTest, AlphaOfAMaskCountsOnce) {
  const std::string exr =
      save("m.exr", picture_of({"R", "G", "B", "A"}, {0.5F, 0.5F, 0.5F, 0.5F}), renderer::PixelType::kFloat);
  const std::string png = save("m.png", picture_of({"R", "G", "B", "A"}, {1, 1, 1, 0.6F}), renderer::PixelType::kUint8);
  EXPECT_NEAR(load_mask(exr, 1, 1)[0], 0.5F, 1e-6F);
  EXPECT_NEAR(load_mask(png, 1, 1)[0], 0.6F, 1e-6F);
}

TEST_F(PaintedPictureTest, AMaskIsItsLuminance) {
  const std::string file = save("m.png", picture_of({"Y"}, {0, 1}), renderer::PixelType::kUint8);
  const std::vector<float> mask = load_mask(file, 2, 1);
  EXPECT_NEAR(mask[0], 0, 1e-6F);
  EXPECT_NEAR(mask[1], 1, 1e-6F);
  EXPECT_THROW(load_mask(file, 1, 2), renderer::Error);
}

}  // namespace
}  // namespace chiaro::cli
