#include "renderer/image/decode_avif.h"

#include <memory>
#include <new>

#include <avif/avif.h>
#include <fmt/format.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

const std::uint8_t* bytes_of(std::string_view encoded) { return reinterpret_cast<const std::uint8_t*>(encoded.data()); }

[[noreturn]] void fail(const std::string& file, const std::string& problem, const std::string& expected) {
  throw Error({file, "", problem, expected});
}

[[noreturn]] void fail(const std::string& file, const std::string& problem) { fail(file, problem, "a whole AVIF"); }

void check(avifResult result, const std::string& file) {
  if (result == AVIF_RESULT_OK) return;
  if (result == AVIF_RESULT_OUT_OF_MEMORY) throw std::bad_alloc();
  fail(file, fmt::format("cannot be decoded: {}", avifResultToString(result)));
}

// ISO/IEC 23008-12, irot and imir: quarter turns anticlockwise, then a mirror, as the orientation of TIFF 6.0 and Exif.
int orientation_of(const avifImage& image) {
  constexpr int kTurned[] = {1, 8, 3, 6}, kThenTopForBottom[] = {4, 5, 2, 7}, kThenLeftForRight[] = {2, 7, 4, 5};
  const int quarters = (image.transformFlags & AVIF_TRANSFORM_IROT) != 0 ? image.irot.angle % 4 : 0;
  if ((image.transformFlags & AVIF_TRANSFORM_IMIR) == 0) return kTurned[quarters];
  return image.imir.mode == 0 ? kThenTopForBottom[quarters] : kThenLeftForRight[quarters];
}

struct DestroyDecoder {
  void operator()(avifDecoder* decoder) const { avifDecoderDestroy(decoder); }
};

class AvifReader {
 public:
  AvifReader(std::string_view encoded, const std::string& file) : file_(file), decoder_(avifDecoderCreate()) {
    if (!decoder_) throw std::bad_alloc();
    decoder_->codecChoice =
        AVIF_CODEC_CHOICE_AOM;  // dav1d writes to the terminal, and takes 6 GB for a frame of 300 bytes
    // As files of other programs are.
    decoder_->strictFlags &= ~avifStrictFlags(AVIF_STRICT_PIXI_REQUIRED | AVIF_STRICT_ALPHA_ISPE_REQUIRED);
    decoder_->requestedSource = AVIF_DECODER_SOURCE_PRIMARY_ITEM;  // and not an animation
    decoder_->ignoreExif = decoder_->ignoreXMP = AVIF_TRUE;
    check(avifDecoderSetIOMemory(decoder_.get(), bytes_of(encoded), encoded.size()), file);
    check(avifDecoderParse(decoder_.get()), file);
    header_ = checked_header();
  }

  const SamplesHeader& header() const { return header_; }

  std::vector<std::uint8_t> samples() {
    check(avifDecoderNextImage(decoder_.get()), file_);
    require_one_piece();
    const SamplesHeader decoded = checked_header();
    if (decoded.bytes() != header_.bytes()) fail(file_, "contradicts itself");
    std::vector<std::uint8_t> samples(header_.bytes());
    avifRGBImage rgb;
    avifRGBImageSetDefaults(&rgb, decoder_->image);
    rgb.format = header_.channels == 4 ? AVIF_RGB_FORMAT_RGBA : AVIF_RGB_FORMAT_RGB;
    rgb.depth = std::uint32_t(8 * header_.bytes_per_sample);
    rgb.chromaUpsampling = AVIF_CHROMA_UPSAMPLING_BEST_QUALITY;
    rgb.avoidLibYUV = AVIF_TRUE;  // which is less precise
    rgb.pixels = samples.data();
    rgb.rowBytes = std::uint32_t(samples.size() / std::size_t(header_.height));
    check(avifImageYUVToRGB(decoder_->image, &rgb), file_);
    return samples;
  }

 private:
  // Planes are the codec's own, unless libavif has made others: of pieces, or by scaling a frame of another size than
  // the header says.
  void require_one_piece() const {
    if (decoder_->image->imageOwnsYUVPlanes == AVIF_FALSE) return;
    fail(file_, "is of pieces, or of another size than it says", "an AVIF of one piece");
  }

  SamplesHeader checked_header() const {
    const avifImage& image = *decoder_->image;
    if ((image.transformFlags & AVIF_TRANSFORM_CLAP) != 0)
      fail(file_, "is to be cropped", "an AVIF that is shown whole");
    if (image.alphaPremultiplied != 0) fail(file_, "has colours multiplied by alpha", "colours as they are");
    return {int(image.width),
            int(image.height),
            decoder_->alphaPresent != 0 ? 4 : 3,
            image.depth > 8 ? 2 : 1,
            uncommon_curve(image.transferCharacteristics),
            orientation_of(image)};
  }

  const std::string& file_;
  std::unique_ptr<avifDecoder, DestroyDecoder> decoder_;
  SamplesHeader header_;
};

}  // namespace

bool is_avif(std::string_view encoded) {
  const avifROData data{bytes_of(encoded), encoded.size()};
  return avifPeekCompatibleFileType(&data) == AVIF_TRUE;
}

SamplesHeader read_avif_header(std::string_view encoded, const std::string& file) {
  return AvifReader(encoded, file).header();
}

std::vector<std::uint8_t> decode_avif(std::string_view encoded, const std::string& file) {
  return AvifReader(encoded, file).samples();
}

}  // namespace chiaro::renderer
