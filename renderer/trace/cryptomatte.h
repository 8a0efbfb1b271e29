#pragma once
// Cryptomatte: which objects and materials a pixel shows, and how much of it, as compositors read it.
// Source: Friedman, Jones, Fully Automatic ID Mattes with Support for Motion Blur and Transparency, 2015; Cryptomatte
// Specification 1.2.0, Psyop, 2018.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::renderer {

// MurmurHash3_x86_32 of Appleby, seed 0.
std::uint32_t murmur_hash_3_32(std::string_view text);

// The identifier of a name: its hash, with one bit of the exponent turned where the float of these bits would be zero,
// denormal, infinite or not a number.
std::uint32_t matte_id(std::string_view name);

// Of every instance and every material of a scene; materials without a name are called material_INDEX.
struct MatteIds {
  std::vector<std::uint32_t> objects, materials;
};
MatteIds matte_ids(const Scene& scene);

// A layer's name and its manifest: names of what the scene draws, and their identifiers, sorted by name.
struct Matte {
  std::string layer;
  std::vector<std::pair<std::string, std::uint32_t>> manifest;
};
std::vector<Matte> mattes_of(const Scene& scene);

inline constexpr int kMatteLevels = 6;
inline constexpr const char* kMatteLayers[2] = {"CryptoObject", "CryptoMaterial"};

// CryptoObject00.R … CryptoObject02.A: identifier and coverage in turn.
std::vector<std::string> matte_channels(std::string_view layer);

// Samples of a pixel that show one identifier, in either half of the frame.
struct MatteCount {
  std::uint32_t id;
  std::array<float, 2> samples;
};
using MatteSums = std::vector<MatteCount>;

void add_matte(MatteSums& sums, std::uint32_t id, int half, float samples);

// The kMatteLevels largest coverages, largest first, written as identifier and coverage in turn; zeros behind.
void write_mattes(const MatteSums& sums, std::array<double, 2> half_weights, float* channels);

}  // namespace chiaro::renderer
