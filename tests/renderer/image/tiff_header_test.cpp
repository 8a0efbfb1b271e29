#include "renderer/image/tiff_header.h"

#include <gtest/gtest.h>

#include "renderer/image/image_file.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

struct Tag {
  int number, type, count, value;  // types: 3 of two bytes, 4 of four
};

// Little or big endian; offsets of four bytes, or of eight as BigTIFF has them.
class TiffWriter {
 public:
  TiffWriter(bool little, bool big, int type_of_bits = 3) : little_(little), big_(big), type_of_bits_(type_of_bits) {}

  // Two pixels of eight bits, 1 and 0, in a palette of `colors` numbers: red, green and blue of all are 0xABAB, but
  // for the blue of colour 1, if there are 256.
  std::string with_palette(int colors) {
    const int offset = big_ ? 8 : 4, header = big_ ? 16 : 8, entries = 9;
    const int pixels = header + (big_ ? 8 : 2) + entries * (4 + 2 * offset) + offset, palette = pixels + 2;
    const Tag tags[entries] = {{256, 3, 1, 2},
                               {257, 3, 1, 1},
                               {258, type_of_bits_, 1, 8},
                               {259, 3, 1, 1},
                               {262, type_of_bits_, 1, 3},
                               {273, 4, 1, pixels},
                               {278, 3, 1, 1},
                               {279, 4, 1, 2},
                               {320, 3, colors, palette}};
    bytes_ = little_ ? "II" : "MM";
    number(big_ ? 43 : 42, 2);
    if (big_) number(8, 2), number(0, 2);
    number(header, offset);
    number(entries, big_ ? 8 : 2);
    for (const Tag& tag : tags) {
      number(tag.number, 2), number(tag.type, 2), number(tag.count, offset);
      const int width = tag.count == 1 && tag.type == 3 ? 2 : tag.count == 1 ? 4 : offset;
      number(tag.value, width);
      bytes_.append(std::size_t(offset - width), '\0');
    }
    number(0, offset);
    bytes_ += std::string("\1\0", 2);
    for (int i = 0; i < colors; ++i) number(i == 2 * 256 + 1 ? 0x1111 : 0xABAB, 2);
    return bytes_;
  }

 private:
  void number(int value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      const int byte = little_ ? i : bytes - 1 - i;
      bytes_ += byte < 4 ? char(value >> (8 * byte) & 0xff) : '\0';
    }
  }

  bool little_, big_;
  int type_of_bits_;
  std::string bytes_;
};

struct Kind {
  bool little, big;
  int type_of_bits;
};

TEST(TiffHeader, PalettesOfAnotherLengthAreRefused) {
  const test::TemporaryFolder folder;
  for (const Kind& kind :
       {Kind{true, true, 3}, {true, false, 4}, {false, true, 3}, {false, false, 3}, {false, false, 4}}) {
    const auto write = [&](const std::string& name, int colors) {
      return folder.write(name, TiffWriter(kind.little, kind.big, kind.type_of_bits).with_palette(colors));
    };
    const auto path = write("t.tif", 3 * 256);
    EXPECT_EQ(find_tiff_header_damage(path), std::nullopt);
    const Image image = load_image(path).image;
    ASSERT_EQ(image.pixels.size(), 6U);
    EXPECT_FLOAT_EQ(image.pixels[0], 0xAB / 255.0F);
    EXPECT_FLOAT_EQ(image.pixels[2], 0x11 / 255.0F);
    for (const int colors : {3, 767, 769}) {
      const auto other = write("o.tif", colors);
      EXPECT_EQ(find_tiff_header_damage(other), "its palette has " + std::to_string(colors) + " numbers, not 768");
      EXPECT_NE(test::error_of([&] { load_image(other); }).find("o.tif: its palette has"), std::string::npos);
    }
  }
}

TEST(TiffHeader, WhatCannotBeReadIsNotItsConcern) {
  const test::TemporaryFolder folder;
  const std::string whole = TiffWriter(true, false).with_palette(3);
  for (const std::size_t size : {0, 3, 8, 40}) {
    EXPECT_EQ(find_tiff_header_damage(folder.write("t.tif", whole.substr(0, size))), std::nullopt) << size;
  }
  EXPECT_EQ(find_tiff_header_damage(folder / "none.tif"), std::nullopt);
}

}  // namespace
}  // namespace chiaro::renderer
