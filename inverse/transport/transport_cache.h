#pragma once
// The responses of all receivers to unity lights on a grid, and their file.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "inverse/transport/light_grid.h"
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
};

// An OpenEXR file: width = receivers, height = lights; half channels `visibility`, `indirect.R/.G/.B`; the rest in the
// header.
void save_transport_cache(const TransportCache& cache, const std::filesystem::path& path);

// Everything but the entries.
TransportCache load_transport_cache_header(const std::filesystem::path& path);

// With the columns of `receivers` only (ascending); absent: all. Error where the file is not a cache, is truncated, or
// was written by another version of the format.
TransportCache load_transport_cache(const std::filesystem::path& path,
                                    std::optional<std::span<const std::size_t>> receivers = {});

}  // namespace chiaro::inverse
