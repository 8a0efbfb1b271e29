#include "renderer/image/image_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "renderer/core/atomic_file.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/associated_tiff.h"
#include "tests/support/from_base64.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

using renderer::Attributes;
using renderer::AttributeValue;
using renderer::Image;
using renderer::ImageFile;
using renderer::load_image;
using renderer::make_image;
using renderer::PixelType;
using renderer::save_image;
using test::from_base64;

Image layered_image() {
  Image image = make_image(7, 5, {"R", "G", "B", "A", "albedo.R", "light.key lamp.B", "depth", "visibility"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i % 53) / 7 - 1;
  return image;
}

Attributes frame_attributes() {
  std::array<float, 16> matrix;
  for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i] = float(i) + 0.5F;
  return {{"chromaticities", std::array<float, 8>{0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.329F}},
          {"whiteLuminance", 1.0F},
          {"worldToCamera", matrix},
          {"worldToNDC", matrix},
          {"samples", 64},
          {"owner", std::string("somebody")},
          {"capDate", std::string("2001:02:03 04:05:06")},
          {"chiaro:grid", std::string("8, 8, 8")},
          {"chiaro:longReceiverFingerprintName", std::string(100000, 'f')},
          {"lensShift", std::array<float, 2>{1, 2}},
          {"origin", std::array<float, 3>{1, 2, 3}}};
}

const AttributeValue* find(const Attributes& attributes, const std::string& name) {
  for (const auto& [key, value] : attributes) {
    if (key == name) return &value;
  }
  return nullptr;
}

// Largest difference over the channels of `a`, found in `b` by name.
float largest_difference(const Image& a, const Image& b) {
  float largest = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      for (int c = 0; c < a.channel_count(); ++c) {
        largest = std::max(largest, std::abs(a.at(x, y)[c] - b.at(x, y)[b.find_channel(a.channel_names[c])]));
      }
    }
  }
  return largest;
}

void expect_same_layout(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.channel_count(), b.channel_count());
  for (const std::string& name : a.channel_names) ASSERT_GE(b.find_channel(name), 0) << name;
}

// libjpeg ends the process where it is asked for more.
TEST(JpegFile, OfMorePixelsThanItHoldsIsRefused) {
  const TemporaryFolder folder;
  const Image wide = make_image(65501, 1, {"R", "G", "B"});
  EXPECT_THROW(save_image(wide, folder / "wide.jpg", PixelType::kUint8), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "wide.jpg"));
  EXPECT_NO_THROW(save_image(make_image(65500, 1, {"R", "G", "B"}), folder / "wide.jpg", PixelType::kUint8));
}

TEST(ExrFile, FloatPixelsAndAttributesComeBack) {
  const TemporaryFolder folder;
  const Image image = layered_image();
  save_image(image, folder / "frame.exr", PixelType::kFloat, frame_attributes());
  const ImageFile loaded = load_image(folder / "frame.exr");
  expect_same_layout(image, loaded.image);
  EXPECT_EQ(largest_difference(image, loaded.image), 0);
  for (const auto& [name, value] : frame_attributes()) {
    const AttributeValue* found = find(loaded.attributes, name);
    ASSERT_NE(found, nullptr) << name;
    EXPECT_EQ(*found, value) << name;
  }
}

TEST(ExrFile, HalvesRoundAndDoNotOverflow) {
  const TemporaryFolder folder;
  Image image = layered_image();
  image.pixels[0] = 1e9F;
  image.pixels[1] = -1e9F;
  save_image(image, folder / "frame.exr", PixelType::kHalf);
  const ImageFile loaded = load_image(folder / "frame.exr");
  EXPECT_EQ(loaded.image.at(0, 0)[loaded.image.find_channel("R")], 65504.0F);
  EXPECT_EQ(loaded.image.at(0, 0)[loaded.image.find_channel("G")], -65504.0F);
  image.pixels[0] = 65504;
  image.pixels[1] = -65504;
  EXPECT_LE(largest_difference(image, loaded.image), 8 * std::exp2(-11.0F));
}

TEST(ExrFile, ChannelsHaveTypesOfTheirOwn) {
  const TemporaryFolder folder;
  Image image = renderer::make_image(2, 1, {"R", "G", "B", "CryptoObject00.R"});
  const std::uint32_t identifier = 0x2e4ff723;
  image.pixels = {1e9F, 0.1F, 0.2F, std::bit_cast<float>(identifier), 0, 0, 0, 1e9F};
  const PixelType half = PixelType::kHalf;
  save_image(image, folder / "frame.exr", {half, half, half, PixelType::kFloat});
  const Image loaded = load_image(folder / "frame.exr").image;
  const int matte = loaded.find_channel("CryptoObject00.R"), red = loaded.find_channel("R");
  EXPECT_EQ(std::bit_cast<std::uint32_t>(loaded.at(0, 0)[matte]), identifier);
  EXPECT_EQ(loaded.at(1, 0)[matte], 1e9F);
  EXPECT_EQ(loaded.at(0, 0)[red], 65504.0F);
}

TEST(ExrFile, TheSameImageIsTheSameFile) {
  const TemporaryFolder folder;
  save_image(layered_image(), folder / "a.exr", PixelType::kHalf);
  const std::string bytes = renderer::read_file(folder / "a.exr");
  EXPECT_EQ(bytes.find("capDate"), std::string::npos) << "no date that nobody asked for";
}

// An EXR's display window, which save_image() makes the same as its data window.
void set_display_window(const std::filesystem::path& path, std::array<std::int32_t, 4> window) {
  std::string bytes = renderer::read_file(path);
  const std::string name("displayWindow\0box2i\0", 20);
  const std::size_t at = bytes.find(name);
  ASSERT_NE(at, std::string::npos);
  std::memcpy(&bytes[at + name.size() + 4], window.data(), sizeof window);
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(ExrFile, PicturesAreAsLargeAsTheirDisplayWindow) {
  const TemporaryFolder folder;
  Image part = make_image(3, 2, {"R"});
  part.pixels = {1, 2, 3, 4, 5, 6};
  const auto path = folder / "part.exr";
  save_image(part, path, PixelType::kFloat);
  set_display_window(path, {-1, 1, 3, 3});
  const Image whole = load_image(path).image;
  EXPECT_EQ(renderer::load_image_header(path).image.width, 5);
  ASSERT_EQ(whole.width, 5);
  ASSERT_EQ(whole.height, 3);
  EXPECT_EQ(whole.pixels, (std::vector<float>{0, 4, 5, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  set_display_window(path, {7, 7, 8, 7});
  EXPECT_EQ(load_image(path).image.pixels, (std::vector<float>{0, 0}));
  set_display_window(path, {0, 0, 99999, 99999});
  EXPECT_NE(error_of([&] { load_image(path); }).find("displayWindow: 100000 x 100000 pixels around"), std::string::npos)
      << error_of([&] { load_image(path); });
}

// Sizes are checked before memory is taken: 64 channels of it would be 31 GB.
TEST(ExrFile, LargeWindowsOfManyChannelsAreRefused) {
  const TemporaryFolder folder;
  std::vector<std::string> names;
  for (int c = 0; c < 64; ++c) names.push_back("c" + std::to_string(c));
  save_image(make_image(1, 1, names), folder / "a.exr", PixelType::kHalf);
  set_display_window(folder / "a.exr", {0, 0, 10999, 10999});
  EXPECT_NE(error_of([&] { load_image(folder / "a.exr"); }).find("displayWindow"), std::string::npos);
}

TEST(ExrFile, TheHeaderAloneHasNoPixels) {
  const TemporaryFolder folder;
  save_image(layered_image(), folder / "frame.exr", PixelType::kHalf, frame_attributes());
  const ImageFile header = renderer::load_image_header(folder / "frame.exr");
  EXPECT_EQ(header.image.width, 7);
  EXPECT_EQ(header.image.channel_count(), 8);
  EXPECT_TRUE(header.image.pixels.empty());
  EXPECT_EQ(std::get<int>(*find(header.attributes, "samples")), 64);
}

TEST(PngFile, EightBitsComeBackUnchanged) {
  const TemporaryFolder folder;
  Image image = make_image(16, 16, {"R", "G", "B", "A"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i * 7 % 256) / 255;
  save_image(image, folder / "picture.png", PixelType::kUint8);
  const ImageFile loaded = load_image(folder / "picture.png");
  expect_same_layout(image, loaded.image);
  EXPECT_LE(largest_difference(image, loaded.image), 1e-6F) << "colour is not multiplied by alpha";
}

TEST(PngFile, MoreChannelsThanItHoldsAreRefused) {
  const TemporaryFolder folder;
  const auto save = [&](const std::string& name) { save_image(layered_image(), folder / name, PixelType::kUint8); };
  EXPECT_NE(error_of([&] { save("frame.png"); }).find("8 channels"), std::string::npos);
  EXPECT_NE(error_of([&] { save("frame.nothing"); }).find("extension"), std::string::npos);
  EXPECT_NE(error_of([&] { save("no such folder/frame.exr"); }), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ImageFile, WhatIsNotAnImageIsRefused) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of([&] { load_image(folder / "not there.exr"); }).find("no such file"), std::string::npos);
  EXPECT_NE(error_of([&] { load_image(folder.path()); }), "");
  const auto text = folder.write("text.exr", "this is not an image");
  EXPECT_NE(error_of([&] { load_image(text); }), "");
  EXPECT_NE(error_of([&] { renderer::load_image_header(text); }), "");
}

std::string encoded(const Image& image, const std::string& name) {
  const TemporaryFolder folder;
  save_image(image, folder / name, PixelType::kUint8);
  return renderer::read_file(folder / name);
}

Image two_texels(const std::vector<std::string>& channels, const std::vector<float>& pixels) {
  Image image = make_image(2, 1, channels);
  image.pixels = pixels;
  return image;
}

TEST(DecodeTexture, EveryNumberOfChannelsBecomesRgba) {
  const auto texels = [](const std::vector<std::string>& channels, const std::vector<float>& pixels) {
    return renderer::decode_texture(encoded(two_texels(channels, pixels), "t.png"), "t").rgba;
  };
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(texels({"Y"}, {0, 1}), (Bytes{0, 0, 0, 255, 255, 255, 255, 255}));
  EXPECT_EQ(texels({"Y", "A"}, {1, 0, 0, 1}), (Bytes{255, 255, 255, 0, 0, 0, 0, 255}));
  EXPECT_EQ(texels({"R", "G", "B"}, {1, 0, 0, 0, 0, 1}), (Bytes{255, 0, 0, 255, 0, 0, 255, 255}));
  EXPECT_EQ(texels({"R", "G", "B", "A"}, {1, 0, 0, 0.2F, 0, 1, 1, 0}), (Bytes{255, 0, 0, 51, 0, 255, 255, 0}))
      << "as stored, not multiplied by alpha";
}

TEST(DecodeTexture, RowsBeginAtTheTop) {
  Image image = make_image(8, 16, {"R", "G", "B"});
  for (int x = 0; x < 8; ++x) image.at(x, 0)[0] = 1;
  for (const char* name : {"t.png", "t.webp"}) {
    const renderer::Texture texture = renderer::decode_texture(encoded(image, name), name);
    ASSERT_EQ(texture.width, 8);
    ASSERT_EQ(texture.height, 16);
    EXPECT_GT(texture.rgba[0], 128) << name;
    EXPECT_LT(texture.rgba[4 * 8 * 15], 64) << name;
  }
}

TEST(DecodeTexture, DamageIsToldWithTheLabel) {
  Image image = make_image(32, 32, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i * i % 251) / 251;
  for (const char* name : {"t.png", "t.jpg"}) {
    const std::string whole = encoded(image, name);
    EXPECT_EQ(renderer::decode_texture(whole, name).rgba.size(), 4096U);
    for (std::size_t size = 0; size < whole.size() - 2; size += 1 + whole.size() / 40) {
      const std::string message = error_of([&] { renderer::decode_texture(whole.substr(0, size), "images[7]"); });
      EXPECT_EQ(message.rfind("images[7]", 0), 0U) << size << " of " << whole.size() << ": " << message;
    }
  }
  std::string flipped = encoded(image, "t.png");
  flipped[flipped.size() / 2] ^= 1;
  EXPECT_NE(error_of([&] { renderer::decode_texture(flipped, "t"); }).find("corrupt"), std::string::npos);
}

// 4 x 2 texels: 200, 100, 50 at alpha 128 above, 10, 20, 30 at alpha 0 below; base64, as OpenImageIO's writer
// multiplies by alpha.
constexpr std::string_view kWebp = "UklGRiIAAABXRUJQVlA4TBYAAAAvA0AAEA9wCqgr+J7CYwCDFvMQ0f8I";

TEST(DecodeTexture, WebpIsAsStoredWhateverItsAlpha) {
  const std::string bytes = from_base64(kWebp);
  const std::vector<std::uint8_t> above{200, 100, 50, 128}, below{10, 20, 30, 0};
  const renderer::Texture texture = renderer::decode_texture(bytes, "t");
  ASSERT_EQ(texture.rgba.size(), 32U);
  for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(texture.rgba[i], i < 16 ? above[i % 4] : below[i % 4]) << i;
  const TemporaryFolder folder;
  const Image image = load_image(folder.write("t.webp", bytes)).image;
  ASSERT_EQ(image.channel_count(), 4);
  for (std::size_t i = 0; i < 32; ++i) EXPECT_NEAR(image.pixels[i] * 255, i < 16 ? above[i % 4] : below[i % 4], 1e-3);
  for (std::size_t size = 0; size < bytes.size() - 2; ++size) {
    EXPECT_NE(error_of([&] { renderer::decode_texture(bytes.substr(0, size), "images[7]"); }).find("images[7]"),
              std::string::npos);
    EXPECT_NE(error_of([&] { load_image(folder.write("cut.webp", bytes.substr(0, size))); }), "");
  }
}

// Its flags say that there is no alpha, which there is.
TEST(DecodeTexture, WebpThatContradictsItselfIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "t.webp", from_base64("UklGRoIAAABXRUJQVlA4WAoAAAAAAAAABwAABwAAQUxQSAwAAAABD/DA/4iIUPiI/gdWUDggUAAAAHADAJ0BKggACA"
                            "AAAAAlqAJ0twD9AP4BSgPwArv/cAARgdy0QAD+//4ih//pXw///zw3VJvn76J8mBR12q//l8qFvYZPn7uTSHxEpq//"
                            "RtAA"));
  EXPECT_NE(error_of([&] { load_image(path); }).find("contradicts itself"), std::string::npos);
}

TEST(ImageFile, SaysWhetherColoursAreMultipliedByAlpha) {
  const TemporaryFolder folder;
  const auto saved = [&](const std::string& name, PixelType type, const std::vector<std::string>& channels) {
    Image image = make_image(2, 2, channels);
    image.pixels.assign(image.pixels.size(), 0.2F);
    save_image(image, folder / name, type);
    return folder / name;
  };
  const auto associated = [](const std::filesystem::path& file) {
    EXPECT_EQ(renderer::load_image_header(file).associated_alpha, load_image(file).associated_alpha) << file;
    return load_image(file).associated_alpha;
  };
  const std::vector<std::string> rgba{"R", "G", "B", "A"};
  EXPECT_TRUE(associated(saved("a.exr", PixelType::kHalf, rgba)));
  EXPECT_FALSE(associated(saved("opaque.exr", PixelType::kHalf, {"R", "G", "B"})));
  EXPECT_FALSE(associated(saved("a.png", PixelType::kUint8, rgba)));
  EXPECT_FALSE(associated(folder.write("a.webp", from_base64(kWebp))));
  for (const PixelType type : {PixelType::kUint8, PixelType::kFloat}) {
    const auto tiff = saved("a.tif", type, rgba);
    EXPECT_FALSE(associated(tiff));
    test::set_associated_alpha(tiff);
    EXPECT_TRUE(associated(tiff));
    EXPECT_NEAR(load_image(tiff).image.pixels[0], 0.2F, 1e-6F) << "as stored";
  }
}

// Of the other formats that OpenImageIO knows the readers trust what files say: films, scans and documents take memory
// as they like, and this one's logical screen is a billion pixels.
TEST(ImageFile, KindsThatAreNotReadAreRefusedUnderAnyName) {
  const TemporaryFolder folder;
  const std::string gif(
      "GIF8`\0\0\x80SDDS P8 \0\0\0\0\xa6\x1f\x34\xc0\x30\x80?3\xff\xf5\xc5[\x97\x37text\xdf\x18\xc0\0\0", 43);
  const std::string psd("8BPS\0\1\0\0\0\0\0\0\0\3\0\0\0\4\0\0\0\5\0\10\0\3\xff\x2e\0\0", 30);
  for (const char* name : {"image.gif", "image.psd", "image.null", "image", "image.exr", "image.jpg", "image.tga"}) {
    for (const std::string& bytes : {gif, psd}) {
      const auto path = folder.write(name, bytes);
      EXPECT_NE(error_of([&] { load_image(path); }).find(name), std::string::npos);
      EXPECT_NE(error_of([&] { renderer::load_image_header(path); }).find(name), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer::tests
