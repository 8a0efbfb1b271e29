#pragma once
// Reflectance of smooth boundaries.

#include <algorithm>
#include <cmath>

namespace chiaro::renderer {

// Refractive index of a solid: of one so near 1 light goes straight through.
inline bool bends(float ior) {
  constexpr float kLeastBending = 0.01F;
  return ior > 1 + kLeastBending;
}

// Schlick's (1 − cosθ)⁵.
inline float schlick_weight(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0F, 1.0F);
  return m * m * m * m * m;
}

// That of a clearcoat, as KHR_materials_clearcoat has it, before its strength.
inline constexpr float kClearcoatF0 = 0.04F;
inline float clearcoat_reflectance(float cosine) { return kClearcoatF0 + (1 - kClearcoatF0) * schlick_weight(cosine); }

// Of a dielectric at normal incidence. eta: refractive index of the far side over that of the near side.
inline float normal_reflectance(float eta) {
  const float root = (eta - 1) / (eta + 1);
  return root * root;
}

// Of a dielectric, unpolarised (Fresnel's equations); 1 where all is reflected. cosine ≥ 0: on the near side.
inline float dielectric_reflectance(float cosine, float eta) {
  const float c = std::min(cosine, 1.0F);
  const float sine2 = (1 - c * c) / (eta * eta);
  if (sine2 >= 1) return 1;
  const float t = std::sqrt(1 - sine2);
  const float parallel = (eta * c - t) / (eta * c + t), perpendicular = (c - eta * t) / (c + eta * t);
  return 0.5F * (parallel * parallel + perpendicular * perpendicular);
}

}  // namespace chiaro::renderer
