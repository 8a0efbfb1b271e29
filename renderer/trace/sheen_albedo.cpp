#include "renderer/trace/sheen_albedo.h"

#include "renderer/core/sampler.h"
#include "renderer/trace/albedo_table.h"

namespace chiaro::renderer {
namespace {

constexpr int kRings = 48, kSectors = 48;

// The fit of Λ, between its tables for a roughness of 0 and of 1.
float fit(float x, float smooth) {
  const auto mix = [smooth](float rough_end, float smooth_end) {
    return (1 - smooth) * rough_end + smooth * smooth_end;
  };
  const float a = mix(21.5473F, 25.3245F), b = mix(3.82987F, 3.32435F), c = mix(0.19823F, 0.16801F);
  const float d = mix(-1.97760F, -1.27393F), e = mix(-4.32054F, -4.85967F);
  return a / (1 + b * std::pow(x, c)) + d * x + e;
}

float lambda(float cosine, float alpha) {
  const float smooth = (1 - alpha) * (1 - alpha);
  return std::exp(cosine < 0.5F ? fit(cosine, smooth) : 2 * fit(0.5F, smooth) - fit(1 - cosine, smooth));
}

// Midpoints of equal steps in the cosine and the angle around.
float integrate(float cosine, float alpha) {
  const Vec3f wo{std::sqrt(1 - cosine * cosine), 0, cosine};
  double sum = 0;
  for (int r = 0; r < kRings; ++r) {
    for (int s = 0; s < kSectors; ++s) {
      const float z = (float(r) + 0.5F) / kRings, phi = kPi * (float(s) + 0.5F) / kSectors;
      const float sine = std::sqrt(1 - z * z);
      const Vec3f wi{sine * std::cos(phi), sine * std::sin(phi), z};
      const Vec3f h = normalize(wo + wi);
      sum += double(sheen_value(h.z, wo.z, z, alpha) * z);
    }
  }
  return float(sum * 2 * M_PI / (kRings * kSectors));
}

float at_most_one(float albedo) { return std::min(1.0F, albedo); }

struct Tables {
  AlbedoTable<float> albedo = make_albedo_table<float>(integrate, at_most_one);
  std::array<float, kAlbedoTableSize> larger = means_of_larger(albedo, at_most_one);  // by roughness
};

const Tables& tables() {
  static const Tables made;
  return made;
}

}  // namespace

float sheen_value(float cosine_h, float cosine_o, float cosine_i, float alpha) {
  constexpr float kLeastAlpha = 0.005F;  // roughness 0.07: below it D is a spike at the horizon
  const float inverse = 1 / std::max(alpha, kLeastAlpha);
  const float sine2 = std::max(0.0F, 1 - cosine_h * cosine_h);
  const float d = (2 + inverse) * std::pow(sine2, 0.5F * inverse) * 0.5F * kInvPi;
  const float shadowing = 1 + lambda(cosine_o, alpha) + lambda(cosine_i, alpha);
  return d / std::max(1e-6F, shadowing * 4 * cosine_o * cosine_i);
}

float sheen_albedo(float cosine, float alpha) { return tables().albedo.at(cosine, alpha); }

float mean_sheen_albedo(float alpha) { return tables().albedo.mean_at(alpha); }

float mean_larger_sheen_albedo(float alpha) { return AlbedoTable<float>::between(tables().larger, alpha); }

}  // namespace chiaro::renderer
