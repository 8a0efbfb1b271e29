#pragma once
// Sums of samples per pixel and layer, in tiles of pixels that take their samples together.
//
// Samples come in kBatches batches, each a sequence scrambled by itself, so that their spread tells the error of the
// mean although the samples within a batch are stratified. Even batches are one half of the frame and odd ones the
// other: each half may decide by the other's samples whether it needs more, and has no bias from it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/image/image.h"
#include "renderer/trace/cryptomatte.h"
#include "renderer/trace/path_tracer.h"

namespace chiaro::renderer {

struct PixelSample {
  bool hit = false;
  Vec3f beauty, albedo, normal, position, illumination;
  float depth = 0;                         // metres along the camera's axis
  std::uint32_t object = 0, material = 0;  // Cryptomatte's, where something is hit
  PathLight light;
};

inline constexpr int kBatches = 4;
inline constexpr int kTileSide = 8;

// Pixels x0 … x1−1, y0 … y1−1.
struct FilmTile {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int pixels() const { return width() * (y1 - y0); }
};

// What one pass adds to a tile. Made by Film::make_sums, filled by one thread, given back whole.
struct TileSums {
  std::vector<double> layers;                    // per pixel, half and channel
  std::vector<double> batches;                   // per pixel, batch and R, G, B of the beauty
  std::array<std::vector<MatteSums>, 2> mattes;  // of objects and materials, per pixel; empty: not asked for
  std::uint64_t dropped = 0;                     // samples that were not finite
};

// How far a half of a tile is from its mean: means over its pixels and R, G, B.
struct HalfStatistics {
  double value = 0;     // cd/m²
  double variance = 0;  // of one sample, as stratified: (cd/m²)² · samples
};

class Film {
 public:
  // `samples`: the most of a pixel.
  Film(int width, int height, const std::vector<std::string>& layers, const Lights& lights, int samples);

  bool wants_illumination() const { return illumination_ >= 0; }
  bool wants_mattes() const { return mattes_wanted_; }
  std::size_t light_layers() const { return lights_.size(); }

  std::size_t tile_count() const { return tiles_.size(); }
  int tile_columns() const { return tile_columns_; }
  const FilmTile& tile(std::size_t index) const { return tiles_[index]; }

  TileSums make_sums(std::size_t tile) const;
  void add(TileSums& sums, int pixel, int batch, const PixelSample& sample) const;
  // Adds a pass's sums to the tile, and sets how many samples each batch of its halves has at most now.
  void merge(std::size_t tile, const TileSums& sums, std::array<int, 2> batch_samples);

  // Samples of a batch when its half has been asked for so many per batch: not more than its share of the most.
  int batch_samples(int batch, int asked) const;
  // What each half of a tile has been asked for, per batch.
  std::array<int, 2> asked(std::size_t tile) const { return asked_[tile]; }
  int tile_samples(std::size_t tile) const;  // of a pixel
  HalfStatistics statistics(std::size_t tile, int half) const;
  std::optional<double> relative_standard_error() const;  // of the frame, sqrt(Σ se² / Σ value²); if it is known
  std::uint64_t dropped() const;

  // Black, of the frame's size and channels.
  Image blank() const { return make_image(width_, height_, names_); }
  // Fills it with means; position, depth and normal are means over the samples that hit something.
  void finish(Image& image) const;

 private:
  struct PixelEstimate {
    std::array<double, 3> value{}, variance{};  // of the mean: (cd/m²)² may be more than a float holds
  };
  std::size_t index(std::size_t tile, int pixel) const;
  int half_samples(std::size_t tile, int half) const;
  std::array<double, 2> half_weights(std::size_t tile) const;  // of the halves' sums in the mean
  PixelEstimate estimate(std::size_t tile, int pixel) const;
  void finish_pixel(std::size_t tile, int pixel, float* out) const;

  int width_, height_, samples_;
  std::vector<std::string> names_;
  std::size_t stride_;
  int albedo_ = -1, normal_ = -1, position_ = -1, depth_ = -1, direct_ = -1, indirect_ = -1, illumination_ = -1,
      variance_ = -1, samples_layer_ = -1;
  bool mattes_wanted_ = false;
  std::array<int, 2> matte_layers_{-1, -1};  // first channel
  std::vector<int> lights_;                  // channel of each light's layer, emissive surfaces last
  int tile_columns_;
  std::vector<FilmTile> tiles_;
  std::vector<std::array<int, 2>> asked_;  // per tile and half
  std::vector<float> layers_;              // per pixel, half and channel
  std::vector<float> batches_;             // per pixel, batch, R, G, B
  std::array<std::vector<MatteSums>, 2> mattes_;
  std::vector<std::uint64_t> dropped_;  // per tile
};

}  // namespace chiaro::renderer
