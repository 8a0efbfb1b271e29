#include "renderer/image/decode_samples.h"

#include "renderer/image/decode_avif.h"
#include "renderer/image/decode_png.h"
#include "renderer/image/decode_webp.h"

namespace chiaro::renderer {

bool has_samples(std::string_view encoded) { return is_png(encoded) || is_webp(encoded) || is_avif(encoded); }

SamplesHeader read_samples_header(std::string_view encoded, const std::string& file) {
  if (is_webp(encoded)) return read_webp_header(encoded, file);
  return is_avif(encoded) ? read_avif_header(encoded, file) : read_png_header(encoded, file);
}

std::vector<std::uint8_t> decode_samples(std::string_view encoded, const std::string& file) {
  if (is_webp(encoded)) return decode_webp(encoded, file);
  return is_avif(encoded) ? decode_avif(encoded, file) : decode_png(encoded, file);
}

}  // namespace chiaro::renderer
