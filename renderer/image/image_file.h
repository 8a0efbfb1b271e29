#pragma once
// Image files, through OpenImageIO.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/image/image.h"
#include "renderer/image/texture.h"

namespace chiaro::renderer {

// An attribute of an EXR header; the matrix is written as m44f, row-vector convention of OpenEXR (the caller
// transposes).
using AttributeValue = std::variant<int, float, std::string, std::array<float, 2>, std::array<float, 3>,
                                    std::array<float, 8> /* chromaticities */, std::array<float, 16>>;
using Attributes = std::vector<std::pair<std::string, AttributeValue>>;

struct ImageFile {
  Image image;
  Attributes attributes;       // those of the kinds above
  bool whole_numbers = false;  // pixels are stored as whole numbers, as in display pictures
  bool srgb_curve = false;  // values are on the sRGB curve, as whole-number pixels are where the file says nothing else
  bool associated_alpha = false;  // colours are stored multiplied by the alpha, on whatever curve
  bool part = false;  // the file has pixels of a part of the picture, or of more: OpenEXR's data window is another one
};

// Any file that OpenImageIO reads, values as stored (8-bit as 0 to 1, no colour conversion, not multiplied by alpha or
// divided by it), as it is to be seen (image_orientation.h). Of Radiance's pictures the values are those before
// EXPOSURE and COLORCORR, and PRIMARIES are chromaticities. Error where unreadable, truncated, or not an image.
ImageFile load_image(const std::filesystem::path& path);
// Header only: size, channel names and attributes; pixels stay empty.
ImageFile load_image_header(const std::filesystem::path& path);

enum class PixelType : std::uint8_t { kUint8, kHalf, kFloat };

using ChannelTypes = std::vector<PixelType>;  // of each channel

// Error where files of this extension cannot have so many pixels: a JPEG has at most 65500 across and down.
void require_room_for(int width, int height, const std::filesystem::path& path);

// By the extension of `path` (.exr, .png, .tif, .jpg …), whole or not at all (atomic_file.h). EXR: ZIP compressed, and
// channels may have types of their own.
void save_image(const Image& image, const std::filesystem::path& path, const ChannelTypes& types,
                const Attributes& attributes = {});
void save_image(const Image& image, const std::filesystem::path& path, PixelType type,
                const Attributes& attributes = {});

// Pixels of which save_image holds a channel at the largest half, as they are more.
std::size_t pixels_beyond_half(const Image& image, const ChannelTypes& types);

// Decodes an encoded texture (PNG, JPEG, WebP …) in memory to RGBA of 8 bits, or of 16 where the file has them; `label`
// names it in errors.
Texture decode_texture(std::string_view encoded, const std::string& label);

}  // namespace chiaro::renderer
