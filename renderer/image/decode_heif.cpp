#include "renderer/image/decode_heif.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <new>

#include <fmt/format.h>
#include <libheif/heif.h>

#include "renderer/core/error.h"
#include "renderer/core/first_line.h"

namespace chiaro::renderer {
namespace {

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};

using Context = std::unique_ptr<heif_context, Freed<heif_context_free>>;
using Handle = std::unique_ptr<heif_image_handle, Freed<heif_image_handle_release>>;
using Decoded = std::unique_ptr<heif_image, Freed<heif_image_release>>;
using Options = std::unique_ptr<heif_decoding_options, Freed<heif_decoding_options_free>>;
using Profile = std::unique_ptr<heif_color_profile_nclx, Freed<heif_nclx_color_profile_free>>;

[[noreturn]] void fail(const std::string& file, const std::string& problem) {
  throw Error({file, "", problem, "a whole AVIF or HEIC"});
}

void check(const heif_error& error, const std::string& file) {
  if (error.code == heif_error_Ok) return;
  if (error.code == heif_error_Memory_allocation_error) throw std::bad_alloc();
  fail(file, fmt::format("cannot be decoded: {}", first_line(error.message)));
}

const char* curve_of(const heif_image_handle* handle) {
  heif_color_profile_nclx* read = nullptr;
  if (heif_image_handle_get_nclx_color_profile(handle, &read).code != heif_error_Ok) return nullptr;
  const Profile profile(read);
  return uncommon_curve(int(profile->transfer_characteristics));
}

// ISO/IEC 14496-12, ItemInfoEntry: whether an item is of that type. Its number before has two bytes or four.
bool has_item(std::string_view encoded, std::string_view type) {
  constexpr std::string_view kEntry = "infe";
  for (std::size_t at = encoded.find(kEntry); at != std::string_view::npos; at = encoded.find(kEntry, at + 1)) {
    for (const std::size_t offset : {12, 14}) {
      if (at + offset < encoded.size() && encoded.substr(at + offset).starts_with(type)) return true;
    }
  }
  return false;
}

class HeifReader {
 public:
  HeifReader(std::string_view encoded, const std::string& file) : file_(file), context_(heif_context_alloc()) {
    if (!context_) throw std::bad_alloc();
    require_one_piece(encoded);
    check(heif_context_read_from_memory_without_copy(context_.get(), encoded.data(), encoded.size(), nullptr), file);
    heif_image_handle* handle = nullptr;
    check(heif_context_get_primary_image_handle(context_.get(), &handle), file);
    handle_.reset(handle);
  }

  SamplesHeader header() const {
    if (heif_image_handle_is_premultiplied_alpha(handle_.get()) != 0) {
      throw Error({file_, "", "has colours multiplied by alpha", "colours as they are"});
    }
    const int bits = heif_image_handle_get_luma_bits_per_pixel(handle_.get());
    if (bits < 1 || bits > 16) fail(file_, fmt::format("has samples of {} bits", bits));
    return {heif_image_handle_get_width(handle_.get()), heif_image_handle_get_height(handle_.get()),
            heif_image_handle_has_alpha_channel(handle_.get()) != 0 ? 4 : 3, bits > 8 ? 2 : 1, curve_of(handle_.get())};
  }

  std::vector<std::uint8_t> samples() const {
    const SamplesHeader header = this->header();
    const Decoded image = decoded(header);
    int stride = 0;
    const std::uint8_t* const plane = heif_image_get_plane_readonly(image.get(), heif_channel_interleaved, &stride);
    const bool whole = plane != nullptr && header.width == width_of(image) && header.height == height_of(image);
    const std::size_t row = std::size_t(header.width) * header.channels * header.bytes_per_sample;
    if (!whole || row > std::size_t(stride)) fail(file_, mismatch(header, image));
    std::vector<std::uint8_t> samples(header.bytes());
    for (int y = 0; y < header.height; ++y) std::copy_n(plane + std::size_t(y) * stride, row, &samples[y * row]);
    const int bits = heif_image_get_bits_per_pixel_range(image.get(), heif_channel_interleaved);
    if (header.bytes_per_sample == 2) stretch(bits, samples);
    return samples;
  }

 private:
  // libheif overruns its memory where pieces and the whole have other sizes than they say.
  void require_one_piece(std::string_view encoded) const {
    for (const char* const derived : {"grid", "iovl", "iden"}) {
      if (!has_item(encoded, derived)) continue;
      throw Error({file_, "", "is put together of pieces", "an AVIF or HEIC of one piece"});
    }
  }

  static int width_of(const Decoded& image) { return heif_image_get_width(image.get(), heif_channel_interleaved); }
  static int height_of(const Decoded& image) { return heif_image_get_height(image.get(), heif_channel_interleaved); }

  static std::string mismatch(const SamplesHeader& header, const Decoded& image) {
    return fmt::format("contradicts itself: {} x {} pixels or {} x {}", header.width, header.height, width_of(image),
                       height_of(image));
  }

  // What is missing of it would be made up otherwise.
  Decoded decoded(const SamplesHeader& header) const {
    constexpr heif_chroma kChroma[2][2] = {{heif_chroma_interleaved_RGB, heif_chroma_interleaved_RGBA},
                                           {kWide, kWideWithAlpha}};
    const Options options(heif_decoding_options_alloc());
    if (!options) throw std::bad_alloc();
    options->strict_decoding = 1;
    options->decoder_id = "aom";  // of AVIF: dav1d takes 6 GB for what may say so in 300 bytes
    heif_image* image = nullptr;
    const heif_chroma chroma = kChroma[header.bytes_per_sample - 1][header.channels - 3];
    check(heif_decode_image(handle_.get(), &image, heif_colorspace_RGB, chroma, options.get()), file_);
    return Decoded(image);
  }

  void stretch(int bits, std::vector<std::uint8_t>& samples) const {
    if (bits < 1 || bits > 16) fail(file_, fmt::format("has samples of {} bits", bits));
    const std::uint32_t most = (1U << bits) - 1;
    for (std::size_t i = 0; i < samples.size(); i += 2) {
      std::uint16_t sample;
      std::memcpy(&sample, &samples[i], 2);
      sample = std::uint16_t((std::min<std::uint32_t>(sample, most) * 65535U + most / 2) / most);
      std::memcpy(&samples[i], &sample, 2);
    }
  }

  static constexpr bool kLittle = std::endian::native == std::endian::little;
  static constexpr heif_chroma kWide = kLittle ? heif_chroma_interleaved_RRGGBB_LE : heif_chroma_interleaved_RRGGBB_BE;
  static constexpr heif_chroma kWideWithAlpha =
      kLittle ? heif_chroma_interleaved_RRGGBBAA_LE : heif_chroma_interleaved_RRGGBBAA_BE;

  const std::string& file_;
  Context context_;
  Handle handle_;
};

}  // namespace

// ISO/IEC 14496-12: a box of the file's type comes first. Of the kinds that begin so libheif takes its own alone.
bool is_heif(std::string_view encoded) { return encoded.size() >= 12 && encoded.substr(4, 4) == "ftyp"; }

SamplesHeader read_heif_header(std::string_view encoded, const std::string& file) {
  return HeifReader(encoded, file).header();
}

std::vector<std::uint8_t> decode_heif(std::string_view encoded, const std::string& file) {
  return HeifReader(encoded, file).samples();
}

}  // namespace chiaro::renderer
