#pragma once
// The responses of all receivers to unity lights on a grid, and their file.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "inverse/transport/light_grid.h"
#include "renderer/image/exr_tiles.h"
#include "renderer/scene/material_override.h"

namespace chiaro::inverse {

// Settings of a bake that its result depends on.
struct BakeSettings {
  int samples = 256;  // gather rays per receiver
  int bounces = -1;   // as TraceOptions
  std::uint64_t seed = 0;
  std::string materials;  // "gltf", "diffuse", or "albedo R,G,B"
};

// Row-major by light: entry (light, receiver) is at light * receiver_count + receiver.
struct TransportCache {
  LightGrid grid;
  std::size_t receiver_count = 0;
  std::vector<std::uint8_t> visibility;  // 1: nothing stands between
  std::vector<Vec3f> indirect;           // cd/m² per candela of each channel
  std::string scene_fingerprint, receiver_fingerprint;
  BakeSettings settings;
  double indirect_relative_error = 0;  // measured against the path tracer on a sample of entries
  float indirect_scale = 1;            // files hold the indirect part times this, so that halves do
};

// A power of two by which what lights bring fits into halves where surfaces around them are so many metres across.
float indirect_scale_for(float across);

// The entries of some receivers under some lights, row-major by light.
struct TransportBlock {
  std::size_t first_light = 0, light_count = 0, first_receiver = 0, receiver_count = 0;
  std::vector<std::uint8_t> visibility;
  std::vector<Vec3f> indirect;

  void resize();  // to its counts, zero
};

// An OpenEXR file of tiles: width = receivers, height = lights; half channels `visibility`, `indirect.R/.G/.B`; the
// rest in the header. docs/caches.md has all of it.
class TransportCacheWriter {
 public:
  static constexpr std::size_t kLights = 1024;  // of a tile
  // A tile has one receiver, so that a solve reads no others; several where lights are few, as tiny tiles take more
  // room.
  static constexpr std::size_t kMostReceivers = 64;
  static std::size_t receivers_of_tile(std::size_t lights);

  // `header`: all but the entries. Receivers [first, last) will be written, where both are of whole tiles; others are
  // in files of their own.
  TransportCacheWriter(const std::filesystem::path& path, const TransportCache& header, std::size_t first_receiver,
                       std::size_t last_receiver);
  // Whole tiles, in the order of lights, then of receivers: all receivers where there are more than kLights lights.
  void write(const TransportBlock& block);
  void flush() { file_.flush(); }
  void close();

 private:
  float scale_;
  renderer::ExrTileWriter file_;
};

// What a file has of a cache, whatever the size of its tiles. Reads files that were not finished, as far as they go.
class TransportCacheReader {
 public:
  // Error where it is not a cache of this version, in tiles.
  explicit TransportCacheReader(const std::filesystem::path& path);
  const TransportCache& header() const { return header_; }  // all but the entries
  std::size_t first_receiver() const { return std::size_t(file_.shape().first_column); }
  std::size_t last_receiver() const { return std::size_t(file_.shape().last_column); }
  std::size_t lights_of_tile() const { return std::size_t(file_.shape().tile_height); }
  std::size_t receivers_of_tile() const { return std::size_t(file_.shape().tile_width); }
  const std::filesystem::path& path() const { return file_.path(); }
  bool of_one_bake(const TransportCacheReader& other) const { return file_.attributes() == other.file_.attributes(); }
  bool is_of(const TransportCache& header) const;
  // Fills the block; false where any of it is not in the file, missing or damaged. Decodes all tiles that it touches.
  bool read(TransportBlock& block);

 private:
  renderer::ExrTileReader file_;
  TransportCache header_;
  std::array<int, 4> channels_;  // where the file has them
};

// Everything but the entries.
TransportCache load_transport_cache_header(const std::filesystem::path& path);

// With the columns of `receivers` only (ascending); absent: all. Error where the file is not a cache, is truncated, or
// was written by another version of the format.
TransportCache load_transport_cache(const std::filesystem::path& path,
                                    std::optional<std::span<const std::size_t>> receivers = {});

}  // namespace chiaro::inverse
