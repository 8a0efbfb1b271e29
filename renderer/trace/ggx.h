#pragma once
// The GGX microfacet distribution. Directions are unit, in the frame of the normal (+Z), and above it.
// Source: Walter, Marschner, Li, Torrance, Microfacet Models for Refraction through Rough Surfaces, 2007; masking and
// shadowing: Heitz, Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs, 2014.

#include "renderer/core/vec.h"
#include "renderer/trace/fresnel.h"

namespace chiaro::renderer::ggx {

inline float distribution(Vec3f h, float alpha) {
  const float a2 = alpha * alpha;
  const float d = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
  return a2 / (kPi * d * d);
}

// V = G₂ / (4 cosθ_i cosθ_o), height-correlated.
inline float visibility(float cosine_o, float cosine_i, float alpha) {
  const float a2 = alpha * alpha;
  const float o = cosine_i * std::sqrt(cosine_o * cosine_o * (1 - a2) + a2);
  const float i = cosine_o * std::sqrt(cosine_i * cosine_i * (1 - a2) + a2);
  return 0.5F / std::max(o + i, 1e-20F);
}

inline float masking(float cosine, float alpha) {
  const float a2 = alpha * alpha;
  return 2 * cosine / (cosine + std::sqrt(cosine * cosine * (1 - a2) + a2));
}

// Half vectors by the density of those visible from wo.
// Source: Dupuy & Benyoub, Sampling Visible GGX Normals with Spherical Caps, 2023.
inline Vec3f sample_visible_normal(Vec3f wo, float alpha, Vec2f u) {
  const Vec3f stretched = normalize(Vec3f{alpha * wo.x, alpha * wo.y, wo.z});
  const float phi = 2 * kPi * u.x;
  const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  const float sine = std::sqrt(std::clamp(1 - z * z, 0.0F, 1.0F));
  const Vec3f h = Vec3f{sine * std::cos(phi), sine * std::sin(phi), z} + stretched;
  return normalize(Vec3f{alpha * h.x, alpha * h.y, std::max(h.z, 1e-6F)});
}

// Density of the reflection about such a half vector, per steradian.
inline float reflection_pdf(Vec3f wo, Vec3f h, float alpha) {
  return masking(wo.z, alpha) * distribution(h, alpha) / (4 * wo.z);
}

}  // namespace chiaro::renderer::ggx
