#include <algorithm>
#include <cmath>
#include <span>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/file_extension.h"
#include "renderer/core/first_line.h"
#include "renderer/image/image_file.h"

namespace chiaro::renderer {
namespace {

constexpr float kMaxHalf = 65504.0F;

struct SetAttribute {
  OIIO::ImageSpec& spec;
  std::string name;
  void operator()(int value) const { spec.attribute(name, value); }
  void operator()(float value) const { spec.attribute(name, value); }
  void operator()(const std::string& value) const { spec.attribute(name, value); }
  void operator()(const std::array<float, 2>& v) const { set({OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::VEC2}, v.data()); }
  void operator()(const std::array<float, 3>& v) const { set({OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::VEC3}, v.data()); }
  void operator()(const std::array<float, 8>& v) const { set({OIIO::TypeDesc::FLOAT, 8}, v.data()); }
  void operator()(const std::array<float, 16>& v) const { set(OIIO::TypeMatrix44, v.data()); }
  void set(OIIO::TypeDesc type, const float* values) const { spec.attribute(name, type, values); }
};

OIIO::TypeDesc type_desc(PixelType type) {
  return type == PixelType::kUint8 ? OIIO::TypeUInt8 : type == PixelType::kHalf ? OIIO::TypeHalf : OIIO::TypeFloat;
}

OIIO::ImageSpec spec_of(const Image& image, const ChannelTypes& types, const Attributes& attributes) {
  OIIO::ImageSpec spec(image.width, image.height, image.channel_count(), type_desc(types.front()));
  if (std::any_of(types.begin(), types.end(), [&](PixelType type) { return type != types.front(); })) {
    for (const PixelType type : types) spec.channelformats.push_back(type_desc(type));
  }
  spec.channelnames = image.channel_names;
  spec.alpha_channel = image.find_channel("A");
  spec["oiio:UnassociatedAlpha"] = 1;
  spec["compression"] = "zip";
  // Without a date OpenImageIO writes the current one, and the same frame would be another file each time. This it
  // finds, and does not write, as its type is wrong; it would say so on standard error.
  static const bool kQuiet = OIIO::attribute("debug", 0);
  if (kQuiet) spec.attribute("DateTime", 0);
  for (const auto& [name, value] : attributes) {
    std::visit(SetAttribute{spec, name == "capDate" ? "DateTime" : name}, value);
  }
  return spec;
}

bool is_held(float value) { return std::isfinite(value) && std::abs(value) > kMaxHalf; }

// What halves cannot hold would become infinite.
std::vector<float> clamped_to_half(std::span<const float> pixels, const OIIO::ImageSpec& spec) {
  std::vector<float> clamped(pixels.begin(), pixels.end());
  for (int c = 0; c < spec.nchannels; ++c) {
    if (spec.channelformat(c) != OIIO::TypeHalf) continue;
    for (std::size_t i = std::size_t(c); i < clamped.size(); i += std::size_t(spec.nchannels)) {
      if (is_held(clamped[i])) clamped[i] = std::copysign(kMaxHalf, clamped[i]);
    }
  }
  return clamped;
}

// In parts, so that there are never two of a large frame.
bool write_clamped(const Image& image, const OIIO::ImageSpec& spec, OIIO::ImageOutput& output) {
  constexpr int kScanlines = 256;  // whole blocks of OpenEXR's
  const std::size_t row = std::size_t(image.width) * std::size_t(image.channel_count());
  for (int y = 0; y < image.height; y += kScanlines) {
    const int end = std::min(image.height, y + kScanlines);
    const std::vector<float> part =
        clamped_to_half(std::span(image.pixels).subspan(std::size_t(y) * row, std::size_t(end - y) * row), spec);
    if (!output.write_scanlines(y, end, 0, OIIO::TypeFloat, part.data())) return false;
  }
  return true;
}

void check_channels(const Image& image, const std::filesystem::path& path, const OIIO::ImageOutput& output) {
  CHIARO_CHECK(image.pixels.size() == std::size_t(image.width) * image.height * image.channel_names.size());
  if (image.width <= 0 || image.height <= 0 || image.channel_names.empty()) {
    throw Error({path.string(), "", "an image without pixels cannot be written", ""});
  }
  if (image.channel_count() > 4 && !output.supports("nchannels")) {
    throw Error({path.string(), "", fmt::format("{} channels do not fit into this kind of file", image.channel_count()),
                 "at most 4, or an .exr file"});
  }
}

void write(const Image& image, const std::string& name, const OIIO::ImageSpec& spec, OIIO::ImageOutput& output) {
  const bool half = spec.format == OIIO::TypeHalf || !spec.channelformats.empty();
  const bool written = output.open(name, spec) && (half ? write_clamped(image, spec, output)
                                                        : output.write_image(OIIO::TypeFloat, image.pixels.data()));
  if (!output.close() || !written) {
    throw Error({name, "", fmt::format("cannot be written: {}", first_line(output.geterror())), ""});
  }
}

// Encoded in memory where the library can: of its own files, what a full disk does not take is lost without a word.
void write_through_memory(const Image& image, const std::filesystem::path& path, const OIIO::ImageSpec& spec,
                          OIIO::ImageOutput& output) {
  OIIO::Filesystem::IOVecOutput memory;
  if (output.supports("ioproxy") && output.set_ioproxy(&memory)) {
    write(image, path.string(), spec, output);
    write_file_atomically(path, {reinterpret_cast<const char*>(memory.buffer().data()), memory.buffer().size()});
    return;
  }
  write_atomically(path, [&](const std::filesystem::path& aside) {
    try {
      write(image, aside.string(), spec, output);
      load_image(aside);
    } catch (const Error& error) {
      throw Error({path.string(), "", error.parts().problem, ""});
    }
  });
}

}  // namespace

std::size_t pixels_beyond_half(const Image& image, const ChannelTypes& types) {
  const std::size_t channels = image.channel_names.size();
  std::size_t beyond = 0;
  for (std::size_t first = 0; first < image.pixels.size(); first += channels) {
    bool held = false;
    for (std::size_t c = 0; c < channels; ++c)
      held = held || (types[c] == PixelType::kHalf && is_held(image.pixels[first + c]));
    beyond += held ? 1 : 0;
  }
  return beyond;
}

// Beyond it libjpeg ends the process.
void require_room_for(int width, int height, const std::filesystem::path& path) {
  constexpr int kMost = 65500;
  if (std::max(width, height) <= kMost || !has_extension(path, {".jpg", ".jpe", ".jpeg", ".jif", ".jfif", ".jfi"})) {
    return;
  }
  throw Error({path.string(), "", fmt::format("{} x {} pixels do not fit into a JPEG", width, height),
               fmt::format("at most {} across and down, or another kind of file", kMost)});
}

void save_image(const Image& image, const std::filesystem::path& path, PixelType type, const Attributes& attributes) {
  save_image(image, path, ChannelTypes(image.channel_names.size(), type), attributes);
}

void save_image(const Image& image, const std::filesystem::path& path, const ChannelTypes& types,
                const Attributes& attributes) {
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output) {
    // Where it has nothing to say it could not even look for one.
    if (OIIO::geterror().empty()) throw Error({path.string(), "", "not enough memory to write an image", ""});
    throw Error({path.string(), "", "no image format has this extension", ".exr, .png, .tif, .jpg …"});
  }
  check_channels(image, path, *output);
  require_room_for(image.width, image.height, path);
  CHIARO_CHECK(types.size() == image.channel_names.size());
  const OIIO::ImageSpec spec = spec_of(image, types, attributes);
  write_through_memory(image, path, spec, *output);
}

}  // namespace chiaro::renderer
