#pragma once
// Colours of an image file as scene-linear Rec.709.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/image/image_file.h"

namespace chiaro::renderer {

// The attribute by which frames tell their colour space where `chromaticities` cannot.
constexpr const char* kColorSpaceAttribute = "chiaro:color_space";

// The space of an OpenColorIO config that this attribute of a file of floats names; empty: none, or `chromaticities`
// tell.
std::string named_space(const ImageFile& image);

// The pixels of the channels R, G and B, or of the one grey channel, rows from the top. Values on the sRGB curve are
// made linear; primaries are those of the attribute `chromaticities`, else of the named space in the config (as
// find_ocio_config takes it), else Rec.709's. Error, naming `file`, where there are no such channels, primaries or
// space.
std::vector<Vec3f> scene_linear_rec709(const ImageFile& image, const std::string& file,
                                       const std::optional<std::filesystem::path>& config = std::nullopt);

// The same channels as they are stored, as an image of R, G, B.
Image stored_colors(const Image& image, const std::string& file);

// One channel for R, G and B: grey, or grey with alpha.
bool is_grey(const Image& image);

// Whether the attribute `chromaticities` names other primaries than Rec.709's.
bool has_other_primaries(const ImageFile& image, const std::string& file);

}  // namespace chiaro::renderer
