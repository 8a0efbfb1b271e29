#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/core/first_line.h"
#include "renderer/image/decode_samples.h"
#include "renderer/image/encoded_image.h"
#include "renderer/image/image_file.h"
#include "renderer/image/read_through_library.h"

namespace chiaro::renderer {
namespace {

constexpr std::int64_t kMaxTexels = std::int64_t{1} << 28;

// Of the formats that are read here, those that textures come in.
bool is_of_textures(std::string_view format) {
  return format == "png" || format == "jpeg" || format == "webp" || format == "avif";
}

[[noreturn]] void fail(const std::string& label, const std::string& problem) {
  throw Error({label, "", problem, "a PNG, JPEG, WebP or AVIF image"});
}

// What an image says it has, beside the bytes that it is encoded in.
struct Size {
  std::int64_t width, height, depth, channels;
  std::uintmax_t bytes;
};

void check_size(const Size& size, std::size_t encoded_bytes, const std::string& label) {
  if (size.width <= 0 || size.height <= 0 || size.channels <= 0 || size.depth > 1 ||
      size.width * size.height > kMaxTexels / std::max<std::int64_t>(1, size.channels / 4)) {
    fail(label, fmt::format("has {} x {} pixels with {} channels", size.width, size.height, size.channels));
  }
  if (!may_hold(encoded_bytes, size.bytes)) fail(label, "has more pixels than so few bytes can hold");
}

std::vector<std::uint8_t> read_texels(OIIO::ImageInput& input, std::size_t encoded_bytes, const std::string& label) {
  const OIIO::ImageSpec& spec = input.spec();
  check_size({spec.width, spec.height, spec.depth, spec.nchannels, spec.image_bytes(true)}, encoded_bytes, label);
  std::vector<std::uint8_t> texels(std::size_t(spec.width) * spec.height * spec.nchannels);
  const bool read = input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeUInt8, texels.data());
  const std::string message = input.geterror();
  if (!read || tells_damage(input.format_name(), message)) {
    fail(label, fmt::format("cannot be decoded: {}", first_line(message)));
  }
  return texels;
}

// One channel is grey, two are grey and alpha, three are RGB.
template <class Channel>
std::vector<Channel> four_channels_of(const std::vector<Channel>& texels, int channels) {
  const std::size_t count = texels.size() / channels;
  std::vector<Channel> rgba(4 * count);
  const int g = channels >= 3 ? 1 : 0, b = channels >= 3 ? 2 : 0, a = channels == 2 ? 1 : 3;
  for (std::size_t i = 0; i < count; ++i) {
    const Channel* texel = &texels[i * channels];
    const Channel opaque = std::numeric_limits<Channel>::max();
    const Channel values[4] = {texel[0], texel[g], texel[b], a < channels ? texel[a] : opaque};
    std::copy(values, values + 4, &rgba[4 * i]);
  }
  return rgba;
}

template <class Channel>
Texture texture_of(std::vector<Channel> texels, int width, int height, int channels) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  rgba_of<Channel>(texture) = channels == 4 ? std::move(texels) : four_channels_of(texels, channels);
  return texture;
}

Texture decoded_texture(OIIO::ImageInput& input, std::size_t encoded_bytes, const std::string& label) {
  std::vector<std::uint8_t> texels = read_texels(input, encoded_bytes, label);
  const OIIO::ImageSpec& spec = input.spec();
  return texture_of(std::move(texels), spec.width, spec.height, spec.nchannels);
}

// Of two bytes each.
std::vector<std::uint16_t> wide_samples(const std::vector<std::uint8_t>& samples) {
  std::vector<std::uint16_t> wide(samples.size() / 2);
  std::memcpy(wide.data(), samples.data(), samples.size());
  return wide;
}

// Samples of 8 bits that were written as 16: 257 v / 65535 = v / 255.
bool hold_bytes(const std::vector<std::uint16_t>& samples) {
  return std::all_of(samples.begin(), samples.end(), [](std::uint16_t sample) { return sample % 257 == 0; });
}

std::vector<std::uint8_t> narrowed(const std::vector<std::uint16_t>& samples) {
  std::vector<std::uint8_t> bytes(samples.size());
  std::transform(samples.begin(), samples.end(), bytes.begin(),
                 [](std::uint16_t sample) { return std::uint8_t(sample / 257); });
  return bytes;
}

Texture decode_samples_texture(std::string_view encoded, const std::string& label) {
  const SamplesHeader header = read_samples_header(encoded, label);
  check_size({header.width, header.height, 1, header.channels, header.bytes()}, encoded.size(), label);
  if (header.orientation != 1) fail(label, "is to be turned or mirrored before it is shown");
  std::vector<std::uint8_t> samples = decode_samples(encoded, label);
  const auto texture = [&](auto texels) {
    return texture_of(std::move(texels), header.width, header.height, header.channels);
  };
  if (header.bytes_per_sample == 1) return texture(std::move(samples));
  std::vector<std::uint16_t> wide = wide_samples(samples);
  return hold_bytes(wide) ? texture(narrowed(wide)) : texture(std::move(wide));
}

// By the reader of that format alone: others that OpenImageIO would try read a file that happens to have the name.
Texture decode_by(std::string_view format, const std::string& path, const OIIO::ImageSpec& config,
                  std::size_t encoded_bytes, const std::string& label) {
  const auto input = OIIO::ImageInput::create(std::string(format));
  OIIO::ImageSpec spec;
  if (!input) fail(label, fmt::format("cannot be decoded: this OpenImageIO has no reader of {}", format));
  if (!input->open(path, spec, config)) {
    fail(label, fmt::format("cannot be decoded: {}", first_line(input->geterror())));
  }
  return decoded_texture(*input, encoded_bytes, label);
}

Texture decode(std::string_view encoded, std::string_view format, const std::string& label) {
  if (has_samples(encoded)) return decode_samples_texture(encoded, label);
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  OIIO::Filesystem::IOMemReader reader(const_cast<char*>(encoded.data()), encoded.size());
  OIIO::Filesystem::IOProxy* proxy = &reader;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  return decode_by(format, label, config, encoded.size(), label);
}

}  // namespace

Texture decode_texture(std::string_view encoded, const std::string& label) {
  const std::string_view format = format_of(encoded);
  if (!is_of_textures(format)) fail(label, "is in a format that is not read here");
  if (const auto damage = find_damage(format, encoded)) fail(label, *damage);
  Texture texture = read_through_library(label, [&] { return decode(encoded, format, label); });
  texture.name = label;
  return texture;
}

}  // namespace chiaro::renderer
