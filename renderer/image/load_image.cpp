#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/first_line.h"
#include "renderer/image/decode_samples.h"
#include "renderer/image/encoded_image.h"
#include "renderer/image/exr_chunks.h"
#include "renderer/image/exr_header.h"
#include "renderer/image/image_file.h"
#include "renderer/image/image_orientation.h"
#include "renderer/image/radiance_header.h"
#include "renderer/image/read_through_library.h"
#include "renderer/image/tiff_header.h"

namespace chiaro::renderer {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t{1} << 31;
constexpr std::int64_t kMaxPadded = std::int64_t{1} << 27;  // pixels of a picture that there is only a part of

constexpr const char* kFormats = "an EXR, PNG, JPEG, TIFF, Radiance, WebP, AVIF, TGA or PNM picture";

// OpenImageIO renames some of OpenEXR's attributes on reading; these are the names as the file has them.
std::string exr_name(const std::string& name) {
  static const std::pair<const char*, const char*> kRenamed[] = {{"worldtocamera", "worldToCamera"},
                                                                 {"worldtoscreen", "worldToNDC"},
                                                                 {"Copyright", "owner"},
                                                                 {"DateTime", "capDate"},
                                                                 {"ImageDescription", "comments"},
                                                                 {"ExposureTime", "expTime"},
                                                                 {"FNumber", "aperture"},
                                                                 {"openexr:whiteLuminance", "whiteLuminance"}};
  for (const auto& [renamed, original] : kRenamed) {
    if (name == renamed) return original;
  }
  return name;
}

template <std::size_t N>
std::array<float, N> floats_of(const OIIO::ParamValue& value) {
  std::array<float, N> floats;
  std::memcpy(floats.data(), value.data(), sizeof floats);
  return floats;
}

void append_attribute(Attributes& attributes, const OIIO::ParamValue& value, bool exr) {
  if (value.name().string().starts_with("oiio:")) return;
  const OIIO::TypeDesc type = value.type();
  const std::string name = exr ? exr_name(value.name().string()) : value.name().string();
  const int floats = type.basetype == OIIO::TypeDesc::FLOAT ? int(type.numelements()) * type.aggregate : 0;
  if (type == OIIO::TypeInt) attributes.emplace_back(name, value.get_int());
  if (type == OIIO::TypeString) attributes.emplace_back(name, value.get_string());
  if (floats == 1) attributes.emplace_back(name, value.get_float());
  if (floats == 2) attributes.emplace_back(name, floats_of<2>(value));
  if (floats == 3) attributes.emplace_back(name, floats_of<3>(value));
  if (floats == 8) attributes.emplace_back(name, floats_of<8>(value));
  if (floats == 16) attributes.emplace_back(name, floats_of<16>(value));
}

std::string first_bytes(const std::filesystem::path& path) {
  std::string first(kFormatBytes, 0);
  std::ifstream file(path, std::ios::binary);
  file.read(first.data(), std::streamsize(first.size()));
  first.resize(std::size_t(file.gcount()));
  return first;
}

struct OpenImage {
  std::string_view format;  // OpenImageIO's name of it
  std::string encoded{};    // all bytes of a picture whose samples are decoded here
  SamplesHeader header{};
  std::unique_ptr<OIIO::Filesystem::IOProxy> reader{};
  std::unique_ptr<OIIO::ImageInput> input{};  // of others, and for what else is in a PNG or a WebP
  OIIO::ImageSpec spec{};
  std::optional<RadianceHeader> radiance{};  // of a Radiance picture
  int part = 0;                              // of an OpenEXR file of several
};

bool has_colors(const OIIO::ImageSpec& spec) {
  return spec.channelindex("R") >= 0 && spec.channelindex("G") >= 0 && spec.channelindex("B") >= 0;
}

bool has_a_color(const OIIO::ImageSpec& spec) {
  return spec.channelindex("R") >= 0 || spec.channelindex("G") >= 0 || spec.channelindex("B") >= 0;
}

// The first part with colours; where none has, the first: depth may come before them.
int choose_part(OIIO::ImageInput& input, std::string_view format, const std::string& file) {
  if (format != "openexr" || has_colors(input.spec())) return 0;
  int parts_of_colors = has_a_color(input.spec()) ? 1 : 0;
  for (int part = 1; input.seek_subimage(part, 0); ++part) {
    if (has_colors(input.spec())) return part;
    parts_of_colors += has_a_color(input.spec()) ? 1 : 0;
  }
  if (parts_of_colors > 1) throw Error({file, "parts", "have one colour each", "red, green and blue in one part"});
  input.seek_subimage(0, 0);
  return 0;
}

// By the reader of that format alone: others that OpenImageIO would try may take anything for a picture.
std::unique_ptr<OIIO::ImageInput> open_input(const OpenImage& image, const std::filesystem::path& path) {
  OIIO::ImageSpec config, spec;
  config["oiio:UnassociatedAlpha"] = 1;
  if (OIIO::Filesystem::IOProxy* reader = image.reader.get()) {
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &reader);
  }
  auto input = OIIO::ImageInput::create(std::string(image.format));
  if (!input) {
    throw Error(
        {path.string(), "", fmt::format("is {}, which this OpenImageIO does not read", image.format), "an image"});
  }
  if (input->open(path.string(), spec, config)) return input;
  throw Error({path.string(), "", fmt::format("is not an image that can be read: {}", first_line(input->geterror())),
               "an image"});
}

// OpenImageIO decodes AVIF as it opens it, whatever its size.
OIIO::ImageSpec spec_of(const SamplesHeader& header) {
  return {header.width, header.height, header.channels,
          header.bytes_per_sample == 2 ? OIIO::TypeUInt16 : OIIO::TypeUInt8};
}

// Some damage is taken for a picture, or for a size to take memory by: it is found before OpenImageIO sees the file.
OpenImage open(const std::filesystem::path& path) {
  require_file(path, "an image");
  const std::string first = first_bytes(path);
  OpenImage image{format_of(first, path)};
  if (image.format.empty()) throw Error({path.string(), "", "is of no kind that is known", kFormats});
  if (has_samples(first)) {
    image.encoded = read_file(path);
    image.header = read_samples_header(image.encoded, path.string());
    if (image.format == "avif") {
      image.spec = spec_of(image.header);
      return image;
    }
    image.reader = std::make_unique<OIIO::Filesystem::IOMemReader>(image.encoded.data(), image.encoded.size());
  }
  std::optional<std::string> damage = find_damage(image.format, image.format == "jpeg" ? read_file(path) : first);
  if (image.format == "openexr") damage = find_exr_header_damage(path);
  if (image.format == "tiff") damage = find_tiff_header_damage(path);
  if (damage) throw Error({path.string(), "", *damage, "a whole image"});
  image.input = open_input(image, path);
  image.part = choose_part(*image.input, image.format, path.string());
  image.spec = image.input->spec();
  if (image.format == "hdr") image.radiance = read_radiance_header(path);
  return image;
}

// Whole numbers identify things.
void check_color_types(const OpenImage& open, const std::string& file) {
  if (open.format != "openexr") return;
  for (const char* const name : {"R", "G", "B", "Y"}) {
    const int c = open.spec.channelindex(name);
    if (c < 0 || open.spec.channelformat(c).is_floating_point()) continue;
    throw Error({file, std::string("channel ") + name, "has whole numbers", "half or full floats"});
  }
}

void check_curve(const SamplesHeader& header, const std::string& file) {
  if (header.curve == nullptr) return;
  throw Error({file, "colours", fmt::format("have the curve \"{}\"", header.curve), "sRGB's"});
}

void check_size(const OIIO::ImageSpec& spec, const std::string& file) {
  const bool sensible = spec.width > 0 && spec.height > 0 && spec.nchannels > 0 && spec.depth <= 1 &&
                        std::int64_t(spec.width) * spec.height <= kMaxPixels / std::max(1, spec.nchannels / 4);
  if (sensible && !spec.deep) return;
  throw Error({file, "header",
               fmt::format("{} x {} x {} pixels with {} channels{}", spec.width, spec.height, spec.depth,
                           spec.nchannels, spec.deep ? ", deep" : ""),
               "a flat image of a sensible size"});
}

// OpenEXR alone has a data window within a display window. What other formats have is where a page or a layer lay.
OIIO::ImageSpec picture_spec(const OpenImage& open) {
  OIIO::ImageSpec spec = open.spec;
  if (open.format == "openexr") return spec;
  spec.x = spec.y = spec.full_x = spec.full_y = 0;
  spec.full_width = spec.width, spec.full_height = spec.height;
  return spec;
}

int orientation_of(const OpenImage& open) {
  if (open.format == "avif") return open.header.orientation;
  const int orientation = open.format == "openexr" ? 1 : open.spec.get_int_attribute("Orientation", 1);
  // OpenImageIO takes Radiance's "+X +Y" and "-X -Y" for one another.
  const bool other_way = open.format == "hdr" && (orientation == 6 || orientation == 8);
  return other_way ? 14 - orientation : orientation;
}

// The part of the picture that there are pixels of, as OpenEXR's data window within its display window.
bool is_cropped(const OIIO::ImageSpec& spec) {
  return spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
         spec.height != spec.full_height;
}

// Of the whole picture.
void check_window(const OIIO::ImageSpec& spec, const std::string& file) {
  if (!is_cropped(spec)) return;
  const std::int64_t most = kMaxPadded / std::max(1, spec.nchannels / 4);
  if (spec.full_width > 0 && spec.full_height > 0 && std::int64_t(spec.full_width) * spec.full_height <= most) return;
  throw Error({file, "displayWindow",
               fmt::format("{} x {} pixels around a data window of {} x {}", spec.full_width, spec.full_height,
                           spec.width, spec.height),
               fmt::format("at most {} pixels", most)});
}

// OpenImageIO and what decodes the samples here may read a damaged header differently.
void require_same_shape(const OpenImage& open, const OIIO::ImageSpec& spec, const std::string& file) {
  const SamplesHeader& samples = open.header;
  const bool same = spec.width == samples.width && spec.height == samples.height && spec.nchannels == samples.channels;
  if (open.encoded.empty() || same) return;
  throw Error({file, "header",
               fmt::format("contradicts itself: {} x {} x {} or {} x {} x {}", samples.width, samples.height,
                           samples.channels, spec.width, spec.height, spec.nchannels),
               "a whole image"});
}

// OpenImageIO does not say of all formats whose colours never are multiplied that they are not.
bool has_associated_alpha(const OIIO::ImageSpec& spec, std::string_view format) {
  if (spec.alpha_channel < 0 || format == "png" || format == "webp" || format == "avif") return false;
  return format == "openexr" || spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
}

ImageFile header_of(const OpenImage& open, const std::filesystem::path& path) {
  const OIIO::ImageSpec spec = picture_spec(open);
  check_size(spec, path.string());
  check_window(spec, path.string());
  check_color_types(open, path.string());
  check_curve(open.header, path.string());
  require_same_shape(open, spec, path.string());
  ImageFile file;
  file.image = Image{spec.full_width, spec.full_height, spec.channelnames, {}};
  file.part = is_cropped(spec);
  if (is_turned(orientation_of(open))) std::swap(file.image.width, file.image.height);
  const bool exr = open.format == "openexr";
  file.associated_alpha = has_associated_alpha(spec, open.format);
  file.whole_numbers = open.format != "openexr" && !spec.format.is_floating_point();
  file.srgb_curve =
      file.whole_numbers && !OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear");
  for (const OIIO::ParamValue& value : spec.extra_attribs) append_attribute(file.attributes, value, exr);
  if (open.radiance && open.radiance->chromaticities) {
    file.attributes.emplace_back("chromaticities", *open.radiance->chromaticities);
  }
  return file;
}

void decode_pixels(const OpenImage& open, const std::string& file, Image& image) {
  const std::vector<std::uint8_t> samples = decode_samples(open.encoded, file);
  const bool wide = open.header.bytes_per_sample == 2;
  CHIARO_CHECK(samples.size() == image.pixels.size() * (wide ? 2 : 1));
  OIIO::convert_image(image.channel_count(), image.width, image.height, 1, samples.data(),
                      wide ? OIIO::TypeUInt16 : OIIO::TypeUInt8, OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride,
                      image.pixels.data(), OIIO::TypeFloat, OIIO::AutoStride, OIIO::AutoStride, OIIO::AutoStride);
}

// TIFF 6.0, tag PhotometricInterpretation.
enum TiffColors : int { kWhiteIsZero = 0, kBlackIsZero = 1, kRgb = 2, kPalette = 3, kSeparated = 5 };

// OpenImageIO has libtiff make 8 bits of red, green and blue of other colours and of some JPEGs, which it does whatever
// is missing or damaged.
void require_told_damage(const OIIO::ImageSpec& spec, TiffColors colors, const std::string& file) {
  if (OIIO::Strutil::ends_with(spec.get_string_attribute("compression"), "jpeg")) {
    throw Error({file, "pixels", "are JPEGs", "another compression of a TIFF, or a JPEG file"});
  }
  if (colors > kPalette && colors != kSeparated) {
    const std::string name = spec.get_string_attribute("tiff:ColorSpace", "other colours");
    throw Error({file, "pixels", fmt::format("are {}", name), "red, green and blue"});
  }
}

// What OpenImageIO 2.4 does not get right: pixels of other sizes, palettes with more channels and inverted ones are
// wrong, tiles of four inks overrun their memory.
void require_readable_tiff(const OIIO::ImageSpec& spec, const std::string& file) {
  const auto colors = TiffColors(spec.get_int_attribute("tiff:PhotometricInterpretation", kRgb));
  require_told_damage(spec, colors, file);
  if (colors == kPalette && spec.alpha_channel >= 0) {
    throw Error({file, "pixels", "have a palette and alpha", "red, green, blue and alpha"});
  }
  const int bits = spec.get_int_attribute("oiio:BitsPerSample", int(8 * spec.format.size()));
  const bool tiles = spec.tile_width > 0;
  if (bits > 16 && bits != 32 && (bits != 64 || tiles)) {
    throw Error({file, "pixels", fmt::format("have samples of {} bits", bits), "up to 16 bits or 32"});
  }
  if (colors == kWhiteIsZero && (bits > 8 || spec.nchannels > 1)) {
    throw Error({file, "pixels", "have white as zero", "black as zero, but for 8 bits of grey"});
  }
  if (tiles && colors == kSeparated) {
    throw Error({file, "pixels", "are tiles of four inks", "red, green and blue"});
  }
}

// OpenImageIO 2.4 ignores what goes wrong in deflated strips that are read as a whole, and in tiles that several
// threads read: a picture whose rest is missing would be black there. Line by line, or by one thread, it tells.
bool read_tiff(OIIO::ImageInput& input, const std::string& file, Image& image) {
  const OIIO::ImageSpec& spec = input.spec();
  require_readable_tiff(spec, file);
  input.threads(1);
  const bool strips_untold = spec.tile_width == 0 && spec.format.size() <= 2 &&
                             spec.get_string_attribute("compression") == "zip" &&
                             spec.get_string_attribute("planarconfig") != "separate";
  if (!strips_untold) return input.read_image(0, 0, 0, image.channel_count(), OIIO::TypeFloat, image.pixels.data());
  for (int y = 0; y < image.height; ++y) {
    if (!input.read_scanline(spec.y + y, 0, OIIO::TypeFloat, image.at(0, y))) return false;
  }
  return true;
}

void read_pixels(OpenImage& open, const std::string& file, Image& image) {
  if (!open.encoded.empty()) return decode_pixels(open, file, image);
  OIIO::ImageInput& input = *open.input;
  const bool read = open.format == "tiff" ? read_tiff(input, file, image)
                                          : input.read_image(open.part, 0, 0, image.channel_count(), OIIO::TypeFloat,
                                                             image.pixels.data());
  const std::string message = input.geterror();
  if (read && !tells_damage(open.format, message)) return;
  throw Error({file, "pixels", fmt::format("cannot be read: {}", first_line(message)), "a whole file"});
}

// OpenImageIO makes fractions of the most that there could be of OpenEXR's whole numbers.
void restore_whole_numbers(const OIIO::ImageSpec& spec, Image& image) {
  constexpr double kMost = 4294967295.0;
  const std::size_t channels = std::size_t(image.channel_count());
  for (std::size_t c = 0; c < channels; ++c) {
    if (spec.channelformat(int(c)).is_floating_point()) continue;
    for (std::size_t i = c; i < image.pixels.size(); i += channels) image.pixels[i] = float(image.pixels[i] * kMost);
  }
}

// The whole picture: black and transparent where there are no pixels of it, without those beyond its edges.
Image in_window(const Image& part, const OIIO::ImageSpec& spec) {
  Image whole = make_image(spec.full_width, spec.full_height, part.channel_names);
  const std::int64_t left = std::int64_t(spec.x) - spec.full_x, top = std::int64_t(spec.y) - spec.full_y;
  const std::int64_t first = std::max<std::int64_t>(0, left), last = std::min(whole.width + 0L, left + part.width);
  const std::int64_t end = std::min(whole.height + 0L, top + part.height);
  for (std::int64_t y = std::max<std::int64_t>(0, top); y < end && first < last; ++y) {
    const float* const from = part.at(int(first - left), int(y - top));
    std::copy_n(from, (last - first) * part.channel_count(), whole.at(int(first), int(y)));
  }
  return whole;
}

// What the pixels were before they were multiplied for display.
void divide_by(Vec3f multiplied, Image& image) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] /= multiplied[int(i % 3)];
}

ImageFile read_image(const std::filesystem::path& path) {
  OpenImage opened = open(path);
  ImageFile file = header_of(opened, path);
  if (!may_hold(std::filesystem::file_size(path), opened.spec.image_bytes(true))) {
    throw Error({path.string(), "header", "has more pixels than such a file can hold", "a whole image"});
  }
  if (opened.format == "openexr") {
    if (const auto damage = ExrChunks(path).find_damage(opened.part)) {
      throw Error({path.string(), "pixels", *damage, "a whole file"});
    }
  }
  const OIIO::ImageSpec spec = picture_spec(opened);
  Image image = make_image(spec.width, spec.height, std::move(file.image.channel_names));
  read_pixels(opened, path.string(), image);
  if (opened.format == "openexr") restore_whole_numbers(opened.spec, image);
  if (opened.radiance) divide_by(opened.radiance->multiplied, image);
  file.image = upright(file.part ? in_window(image, spec) : std::move(image), orientation_of(opened));
  return file;
}

}  // namespace

ImageFile load_image_header(const std::filesystem::path& path) {
  return read_through_library(path.string(), [&] { return header_of(open(path), path); });
}

ImageFile load_image(const std::filesystem::path& path) {
  return read_through_library(path.string(), [&] { return read_image(path); });
}

}  // namespace chiaro::renderer
