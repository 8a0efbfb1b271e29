#pragma once
// Albedos of a lobe by the cosine of the viewer and by roughness, interpolated linearly.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace chiaro::renderer {

inline constexpr int kAlbedoTableSize = 32;  // steps in the cosine, and in the square root of alpha

inline float mix(float t, float a, float b) { return (1 - t) * a + t * b; }

// Albedo: a float, or a struct of floats for which mix(t, a, b) is declared beside it.
template <class Albedo>
struct AlbedoTable {
  static constexpr int kSize = kAlbedoTableSize;
  std::array<std::array<Albedo, kSize>, kSize> directional;  // [roughness][cosine]
  std::array<Albedo, kSize> mean;                            // [roughness], of cosine-weighted viewers

  // Of the mean over viewers, 2 ∫ albedo cosθ d(cosθ), up to a factor: the trapezoidal rule. (The first step's cosine
  // is zero.)
  static float weight_in_mean(int step) { return step == kSize - 1 ? 0.5F * float(step) : float(step); }

  Albedo at(float cosine, float alpha) const {
    const Place r = place(std::sqrt(alpha)), c = place(cosine);
    const auto &low = directional[r.low], &high = directional[r.low + 1];
    return mix(r.t, mix(c.t, low[c.low], low[c.low + 1]), mix(c.t, high[c.low], high[c.low + 1]));
  }
  Albedo mean_at(float alpha) const { return between(mean, alpha); }
  template <class Value>
  static Value between(const std::array<Value, kSize>& of_roughness, float alpha) {
    const Place r = place(std::sqrt(alpha));
    return mix(r.t, of_roughness[r.low], of_roughness[r.low + 1]);
  }

 private:
  struct Place {
    int low;
    float t;
  };
  static Place place(float x) {
    const float at = std::clamp(x, 0.0F, 1.0F) * (kSize - 1);
    const int low = std::min(int(at), kSize - 2);
    return {low, at - float(low)};
  }
};

// integrate(cosine, alpha): the albedo that viewers of this cosine see. The mean is of value(albedo).
template <class Albedo, class Integrate, class Value = std::identity>
AlbedoTable<Albedo> make_albedo_table(const Integrate& integrate, const Value& value = {}) {
  constexpr int kSize = kAlbedoTableSize;
  constexpr float kLeastRoughness = 0.03F;
  AlbedoTable<Albedo> table;
  for (int r = 0; r < kSize; ++r) {
    const float roughness = std::max(kLeastRoughness, float(r) / (kSize - 1));
    Albedo mean{};
    float total = 0;
    for (int c = 0; c < kSize; ++c) {
      const float cosine = std::max(1e-3F, float(c) / (kSize - 1));
      const Albedo albedo = integrate(cosine, roughness * roughness);
      table.directional[r][c] = albedo;
      const float weight = AlbedoTable<Albedo>::weight_in_mean(c);
      total += weight;
      if (weight > 0) mean = mix(weight / total, mean, value(albedo));
    }
    table.mean[r] = mean;
  }
  return table;
}

// Means of the larger of two cosine-weighted viewers' value(albedo), by roughness.
template <class Albedo, class Value>
std::array<float, kAlbedoTableSize> means_of_larger(const AlbedoTable<Albedo>& table, const Value& value) {
  constexpr int kSize = kAlbedoTableSize;
  std::array<float, kSize> means;
  for (int r = 0; r < kSize; ++r) {
    float sum = 0, total = 0;
    for (int a = 0; a < kSize; ++a) {
      for (int b = 0; b < kSize; ++b) {
        const float weight = AlbedoTable<Albedo>::weight_in_mean(a) * AlbedoTable<Albedo>::weight_in_mean(b);
        sum += weight * std::max(value(table.directional[r][a]), value(table.directional[r][b]));
        total += weight;
      }
    }
    means[r] = sum / total;
  }
  return means;
}

}  // namespace chiaro::renderer
