#include "renderer/trace/light_tree.h"

namespace chiaro::renderer {
namespace {

// The smallest cone around two cones of directions (PBR 4, section 3.8.4).
void unite_cones(const LightBounds& a, Vec3f b_axis, float b_spread, LightBounds& both) {
  const float cosine = std::clamp(dot(a.axis, b_axis), -1.0F, 1.0F), between = std::acos(cosine);
  both.axis = a.axis;
  both.spread = a.spread;
  if (std::min(between + b_spread, kPi) <= a.spread) return;
  both.axis = b_axis;
  both.spread = b_spread;
  if (std::min(between + a.spread, kPi) <= b_spread) return;
  both.spread = 0.5F * (a.spread + between + b_spread);
  const Vec3f across = b_axis - cosine * a.axis;
  if (!(both.spread < kPi) || !(length_squared(across) > 1e-12F)) {
    both.spread = kPi;
    return;
  }
  const float turn = both.spread - a.spread;
  both.axis = normalize(std::cos(turn) * a.axis + std::sin(turn) * normalize(across));
}

}  // namespace

LightBounds bounds_of_both(const LightBounds& a, const LightBounds& b) {
  if (!(a.intensity > 0)) return b;
  if (!(b.intensity > 0)) return a;
  LightBounds both;
  const bool turned = b.two_sided && dot(a.axis, b.axis) < 0;
  unite_cones(a, turned ? -b.axis : b.axis, b.spread, both);
  both.box = a.box;
  both.box.extend(b.box.min);
  both.box.extend(b.box.max);
  both.emission = std::max(a.emission, b.emission);
  both.two_sided = a.two_sided || b.two_sided;
  both.intensity = a.intensity + b.intensity;
  return both;
}

}  // namespace chiaro::renderer
