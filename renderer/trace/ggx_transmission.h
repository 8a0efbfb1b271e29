#pragma once
// Light that GGX facets let through: refracted at the boundary of a solid, or on its way through a thin sheet, whose
// two faces undo each other's refraction. Fresnel's factor is left out. Directions are unit, in the frame of the
// normal; wo is above it, wi below. eta: refractive index of wi's side over that of wo's. Source: Walter, Marschner,
// Li, Torrance, Microfacet Models for Refraction through Rough Surfaces, 2007 (eq. 16, 17, 21), with height-correlated
// masking and shadowing.

#include "renderer/trace/ggx.h"

namespace chiaro::renderer::ggx {

// Value: f · |cosθ_i|; pdf: of sampling a visible half vector from wo, per steradian.
struct Transmission {
  Vec3f half;  // zero: no facet sends light this way
  float value = 0, pdf = 0;
};

inline Vec3f mirrored(Vec3f w) { return {w.x, w.y, -w.z}; }

// G₂ of directions on either side.
inline float masking_shadowing(float cosine_o, float cosine_i, float alpha) {
  return visibility(cosine_o, cosine_i, alpha) * 4 * cosine_o * cosine_i;
}

// As seen from wo: radiance is scaled by 1/eta² on the way.
inline Transmission refraction(Vec3f wo, Vec3f wi, float alpha, float eta) {
  Vec3f h = wo + eta * wi;
  const float length2 = length_squared(h);
  if (!(length2 > 0)) return {};
  h = (h.z < 0 ? -1.0F : 1.0F) / std::sqrt(length2) * h;
  const float o = dot(wo, h), i = dot(wi, h);
  if (!(o > 0 && i < 0)) return {};
  const float denominator = o + eta * i;
  const float common = distribution(h, alpha) * o * -i / (wo.z * denominator * denominator);
  return {h, common * masking_shadowing(wo.z, -wi.z, alpha), common * masking(wo.z, alpha) * eta * eta};
}

inline Transmission thin_transmission(Vec3f wo, Vec3f wi, float alpha) {
  const Vec3f reflected = mirrored(wi), h = normalize(wo + reflected);
  const float value = distribution(h, alpha) * visibility(wo.z, reflected.z, alpha) * reflected.z;
  return {h, value, reflection_pdf(wo, h, alpha)};
}

// The direction into which a facet refracts wo; zero where it reflects all.
inline Vec3f refract(Vec3f wo, Vec3f h, float eta) {
  const float c = dot(wo, h), cosine2 = 1 - (1 - c * c) / (eta * eta);
  if (cosine2 <= 0) return {};
  return normalize((c / eta - std::sqrt(cosine2)) * h - wo / eta);
}

}  // namespace chiaro::renderer::ggx
