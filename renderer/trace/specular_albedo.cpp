#include "renderer/trace/specular_albedo.h"

#include "renderer/core/sampler.h"
#include "renderer/trace/albedo_table.h"
#include "renderer/trace/fresnel.h"
#include "renderer/trace/ggx.h"

namespace chiaro::renderer {

// Found by the table, by the type of its arguments.
static SpecularAlbedo mix(float t, SpecularAlbedo a, SpecularAlbedo b) {
  return {(1 - t) * a.scale + t * b.scale, (1 - t) * a.bias + t * b.bias};
}

namespace {

constexpr int kSamples = 256;

SpecularAlbedo integrate(float cosine, float alpha) {
  const Vec3f wo{std::sqrt(1 - cosine * cosine), 0, cosine};
  SpecularAlbedo sum;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    Sampler sampler(1, 0, k);
    const Vec3f h = ggx::sample_visible_normal(wo, alpha, sampler.next_2d());
    const Vec3f wi = 2 * dot(wo, h) * h - wo;
    if (wi.z <= 0) continue;
    // f cosθ / pdf without Fresnel: G₂ / G₁.
    const float weight = ggx::visibility(wo.z, wi.z, alpha) * 4 * wo.z * wi.z / ggx::masking(wo.z, alpha);
    const float w = schlick_weight(dot(wo, h));
    sum.scale += weight * (1 - w) / kSamples;
    sum.bias += weight * w / kSamples;
  }
  return sum;
}

float of_clearcoat(SpecularAlbedo albedo) { return albedo.at(kClearcoatF0); }

struct Tables {
  AlbedoTable<SpecularAlbedo> albedo = make_albedo_table<SpecularAlbedo>(integrate);
  std::array<float, kAlbedoTableSize> larger_of_clearcoat = means_of_larger(albedo, of_clearcoat);  // by roughness
};

const Tables& tables() {
  static const Tables made;
  return made;
}

}  // namespace

SpecularAlbedo specular_albedo(float cosine, float alpha) { return tables().albedo.at(cosine, alpha); }

SpecularAlbedo mean_specular_albedo(float alpha) { return tables().albedo.mean_at(alpha); }

float mean_larger_clearcoat_albedo(float alpha) {
  return AlbedoTable<SpecularAlbedo>::between(tables().larger_of_clearcoat, alpha);
}

}  // namespace chiaro::renderer
