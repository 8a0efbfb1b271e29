#pragma once
// Sample points that are a function of (seed, stream, index, dimension) alone.
// Source: Burley, Practical Hash-based Owen Scrambling, 2020 (shuffled, scrambled Sobol' pairs, padded over
// dimensions); hash constants for the Laine–Karras permutation after Vegdahl, 2021.

#include <cstdint>

#include "renderer/core/vec.h"

namespace chiaro::renderer {

inline std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b) {
  std::uint32_t h = a ^ (b * 0x9e3779b9U + 0x7f4a7c15U + (a << 6) + (a >> 2));
  h = (h ^ (h >> 16)) * 0x7feb352dU;  // lowbias32 of Wellons, Prospecting for Hash Functions, 2018
  h = (h ^ (h >> 15)) * 0x846ca68bU;
  return h ^ (h >> 16);
}

inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
  x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
  x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
  return __builtin_bswap32(x);
}

// The Laine–Karras permutation: each bit is flipped, or not, by those below it.
inline std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reverse_bits(laine_karras(reverse_bits(x), seed));
}

// The second Sobol' dimension, of the first: with bits as coefficients, highest first, p(x) becomes p(1 + x) modulo 2.
inline std::uint32_t sobol_second_dimension(std::uint32_t first) {
  first ^= first << 16;
  first ^= (first & 0x00ff00ffU) << 8;
  first ^= (first & 0x0f0f0f0fU) << 4;
  first ^= (first & 0x33333333U) << 2;
  first ^= (first & 0x55555555U) << 1;
  return first;
}

// In [0, 1).
inline float unit_float(std::uint32_t bits) { return float(bits >> 8) * 0x1p-24F; }

// Of one of some batches of samples that are scrambled each by itself.
inline std::uint64_t seed_of_batch(std::uint64_t seed, std::uint64_t batch) {
  return seed * 0x9e3779b97f4a7c15ULL + batch;
}

// The points of one pixel's or receiver's sample `index`, dimension by dimension.
class Sampler {
 public:
  Sampler(std::uint64_t seed, std::uint32_t stream, std::uint32_t index)
      : key_(hash_combine(hash_combine(std::uint32_t(seed), std::uint32_t(seed >> 32)), stream)),
        index_(index),
        reversed_index_(reverse_bits(index)) {}

  float next_1d() {
    const std::uint32_t key = next_key();
    return unit_float(owen_scramble(shuffled(key), hash_combine(key, 1)));
  }

  Vec2f next_2d() {
    const std::uint32_t key = next_key();
    const std::uint32_t first = shuffled(key);
    return {unit_float(owen_scramble(first, hash_combine(key, 1))),
            unit_float(owen_scramble(sobol_second_dimension(first), hash_combine(key, 2)))};
  }

  std::uint32_t next_bits() { return hash_combine(next_key(), index_); }

 private:
  std::uint32_t next_key() { return hash_combine(key_, ++dimension_); }
  // The first Sobol' dimension of a point of the sequence, taken in another order by each key.
  std::uint32_t shuffled(std::uint32_t key) const { return laine_karras(reversed_index_, key); }

  std::uint32_t key_, index_, reversed_index_, dimension_ = 0;
};

// Cosine-weighted direction around +Z (Malley's method); pdf = z / π.
inline Vec3f sample_cosine_hemisphere(Vec2f u) {
  const float radius = std::sqrt(u.x), angle = 2 * kPi * u.y;
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0F, 1 - u.x))};
}

}  // namespace chiaro::renderer
