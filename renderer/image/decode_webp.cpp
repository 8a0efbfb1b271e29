#include "renderer/image/decode_webp.h"

#include <webp/decode.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

const std::uint8_t* bytes_of(std::string_view encoded) { return reinterpret_cast<const std::uint8_t*>(encoded.data()); }

[[noreturn]] void fail(const std::string& file, const char* problem) {
  throw Error({file, "", problem, "a whole WebP"});
}

}  // namespace

bool is_webp(std::string_view encoded) {
  return encoded.size() >= 12 && encoded.starts_with("RIFF") && encoded.substr(8, 4) == "WEBP";
}

SamplesHeader read_webp_header(std::string_view encoded, const std::string& file) {
  WebPBitstreamFeatures features;
  const VP8StatusCode status = WebPGetFeatures(bytes_of(encoded), encoded.size(), &features);
  if (status == VP8_STATUS_NOT_ENOUGH_DATA) fail(file, "is truncated");
  if (status != VP8_STATUS_OK) fail(file, "is corrupt");
  if (features.has_animation) throw Error({file, "", "is an animation", "a WebP of one picture"});
  return {features.width, features.height, features.has_alpha ? 4 : 3, 1};
}

std::vector<std::uint8_t> decode_webp(std::string_view encoded, const std::string& file) {
  const SamplesHeader header = read_webp_header(encoded, file);
  std::vector<std::uint8_t> samples(header.bytes());
  auto* const decode = header.channels == 4 ? &WebPDecodeRGBAInto : &WebPDecodeRGBInto;
  const int row = header.width * header.channels;
  if (decode(bytes_of(encoded), encoded.size(), samples.data(), samples.size(), row) == nullptr) {
    fail(file, "is truncated or corrupt");
  }
  return samples;
}

}  // namespace chiaro::renderer
