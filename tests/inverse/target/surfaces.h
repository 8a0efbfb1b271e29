#pragma once
// Small surfaces, and targets on them, made in code.

#include "inverse/target/target.h"

namespace chiaro::inverse::tests {

// A parallelogram of count × count receivers, u fastest; its normal is along cross(u, v).
inline Receivers make_sheet(Vec3f origin, Vec3f u, Vec3f v, int count) {
  Receivers sheet;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      const float s = float(i) / float(count - 1), t = float(j) / float(count - 1);
      sheet.positions.push_back(origin + s * u + t * v);
      sheet.normals.push_back(normalize(cross(u, v)));
      sheet.samples.push_back({sheet.positions.back(), sheet.normals.back()});
    }
  }
  for (int j = 0; j + 1 < count; ++j) {
    for (int i = 0; i + 1 < count; ++i) {
      const auto a = std::uint32_t(j * count + i), b = a + 1, c = a + std::uint32_t(count), d = c + 1;
      sheet.triangles.push_back({a, b, d});
      sheet.triangles.push_back({a, d, c});
    }
  }
  sheet.parts.push_back({"sheet", 0, sheet.positions.size(), 0, sheet.triangles.size()});
  return sheet;
}

// The receivers of `a`, then those of `b`.
inline Receivers join(Receivers a, const Receivers& b) {
  const auto first = std::uint32_t(a.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
  a.samples.insert(a.samples.end(), b.samples.begin(), b.samples.end());
  for (Receivers::Part part : b.parts) {
    part.first_receiver += first;
    part.first_triangle += a.triangles.size();
    a.parts.push_back(part);
  }
  for (const renderer::Triangle& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

// The unit square at y = height in steps of an eighth, so that coordinates are exact. Facing up.
inline Receivers make_floor(float height = 0) { return make_sheet({0, height, 0}, {0, 0, 1}, {1, 0, 0}, 9); }

// In make_floor: of x and z in eighths.
inline std::size_t floor_receiver(int x, int z) { return std::size_t(x) * 9 + std::size_t(z); }

inline Target make_target(const Receivers& receivers, Vec3f illumination, float weight = 1) {
  Target target;
  target.receivers = receivers;
  target.illumination.assign(receivers.size(), illumination);
  target.weight.assign(receivers.size(), weight);
  return target;
}

}  // namespace chiaro::inverse::tests
