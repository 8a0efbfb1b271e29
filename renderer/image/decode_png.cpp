#include "renderer/image/decode_png.h"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <png.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

// PNG, third edition, section 11.3.2.6: primaries, curve, matrix and range by their numbers of ITU-T H.273.
constexpr png_byte kCodePoints[] = "cICP";

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";

// What libpng's callbacks reach. They leave by longjmp(), which passes over nothing that has a destructor.
struct Reading {
  std::string_view left;
  bool truncated = false, palette = false;
  char problem[128] = "";
  std::vector<png_bytep> rows{};
  png_structp png = nullptr;
  png_infop info = nullptr;
};

void keep_problem(png_structp png, png_const_charp message) {
  char* const problem = static_cast<Reading*>(png_get_error_ptr(png))->problem;
  std::strncpy(problem, message, sizeof Reading::problem - 1);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep to, png_size_t count) {
  auto& reading = *static_cast<Reading*>(png_get_io_ptr(png));
  if (count > reading.left.size()) {
    reading.truncated = true;
    png_error(png, "truncated");
  }
  std::copy_n(reading.left.data(), count, to);
  reading.left.remove_prefix(count);
}

// Samples become whole bytes, and what is transparent is in a channel. Palettes are looked up here: libpng takes
// indices beyond them for black.
void read_header(Reading& reading) {
  png_set_crc_action(reading.png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_set_keep_unknown_chunks(reading.png, PNG_HANDLE_CHUNK_ALWAYS, kCodePoints, 1);
  png_read_info(reading.png, reading.info);
  reading.palette = png_get_color_type(reading.png, reading.info) == PNG_COLOR_TYPE_PALETTE;
  reading.palette ? png_set_packing(reading.png) : png_set_expand(reading.png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(reading.png);
  png_set_interlace_handling(reading.png);
  png_read_update_info(reading.png, reading.info);
}

void read_rows(Reading& reading) {
  png_read_image(reading.png, reading.rows.data());
  png_read_end(reading.png, nullptr);
}

bool succeeds(void (*read)(Reading&), Reading& reading) {
  if (setjmp(png_jmpbuf(reading.png)) != 0) return false;
  read(reading);
  return true;
}

class PngReader {
 public:
  PngReader(std::string_view encoded, const std::string& file) : file_(file) {
    reading_.left = encoded;
    reading_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading_, keep_problem, ignore_warning);
    reading_.info = reading_.png != nullptr ? png_create_info_struct(reading_.png) : nullptr;
    if (reading_.info == nullptr) {
      png_destroy_read_struct(&reading_.png, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(reading_.png, &reading_, read_bytes);
  }
  ~PngReader() { png_destroy_read_struct(&reading_.png, &reading_.info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  SamplesHeader header() {
    run(read_header);
    const int width = int(png_get_image_width(reading_.png, reading_.info));
    const int height = int(png_get_image_height(reading_.png, reading_.info));
    if (reading_.palette) return {width, height, palette().second.empty() ? 3 : 4, 1, curve()};
    return {width, height, png_get_channels(reading_.png, reading_.info),
            png_get_bit_depth(reading_.png, reading_.info) / 8, curve()};
  }

  // After the header.
  std::vector<std::uint8_t> samples(const SamplesHeader& header) {
    std::vector<std::uint8_t> samples(header.bytes() / (reading_.palette ? header.channels : 1));
    const std::size_t row = samples.size() / std::size_t(header.height);
    for (int y = 0; y < header.height; ++y) reading_.rows.push_back(&samples[std::size_t(y) * row]);
    run(read_rows);
    return reading_.palette ? looked_up(samples, header) : samples;
  }

 private:
  const char* curve() {
    png_unknown_chunkp chunks = nullptr;
    const int count = png_get_unknown_chunks(reading_.png, reading_.info, &chunks);
    for (const png_unknown_chunk& chunk : std::span(chunks, std::size_t(count))) {
      const bool is_one = std::memcmp(chunk.name, kCodePoints, 4) == 0 && chunk.size == 4;
      if (is_one) return uncommon_curve(chunk.data[1]);
    }
    return nullptr;
  }

  // Colours, and how opaque the first of them are.
  std::pair<std::span<const png_color>, std::span<const png_byte>> palette() {
    png_colorp colors = nullptr;
    png_bytep opacities = nullptr;
    int color_count = 0, opacity_count = 0;
    png_get_PLTE(reading_.png, reading_.info, &colors, &color_count);
    png_get_tRNS(reading_.png, reading_.info, &opacities, &opacity_count, nullptr);
    return {{colors, std::size_t(color_count)}, {opacities, std::size_t(opacity_count)}};
  }

  std::vector<std::uint8_t> looked_up(const std::vector<std::uint8_t>& indices, const SamplesHeader& header) {
    const auto [colors, opacities] = palette();
    std::vector<std::uint8_t> samples;
    samples.reserve(header.bytes());
    for (const std::uint8_t index : indices) {
      if (index >= colors.size()) {
        throw Error(
            {file_, "", fmt::format("is corrupt: colour {} of a palette of {}", index, colors.size()), "a whole PNG"});
      }
      const png_color& color = colors[index];
      samples.insert(samples.end(), {color.red, color.green, color.blue});
      if (header.channels == 4) samples.push_back(index < opacities.size() ? opacities[index] : 255);
    }
    return samples;
  }

  void run(void (*read)(Reading&)) {
    if (succeeds(read, reading_)) return;
    const std::string problem = reading_.problem;
    if (problem == "Out of memory") throw std::bad_alloc();
    throw Error({file_, "", reading_.truncated ? "is truncated" : "is corrupt: " + problem, "a whole PNG"});
  }

  const std::string& file_;
  Reading reading_;
};

}  // namespace

bool is_png(std::string_view encoded) { return encoded.starts_with(kSignature); }

SamplesHeader read_png_header(std::string_view encoded, const std::string& file) {
  return PngReader(encoded, file).header();
}

std::vector<std::uint8_t> decode_png(std::string_view encoded, const std::string& file) {
  PngReader reader(encoded, file);
  return reader.samples(reader.header());
}

}  // namespace chiaro::renderer
