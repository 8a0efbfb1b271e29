#pragma once

#include <array>
#include <optional>

#include "inverse/target/receiver_surface.h"

namespace chiaro::inverse {

// A value at a point of the surface, as a weighted sum of values at receivers.
struct ReceiverWeights {
  std::array<std::uint32_t, 3> receivers{};
  std::array<float, 3> weights{};  // barycentric, ≥ 0, sum 1
};

// Finds the receivers around points of the surface.
class ReceiverLookup {
 public:
  explicit ReceiverLookup(const Receivers& receivers);  // keeps a reference

  // Corners of the triangle that the point lies on, among those that face the same side as `normal` (unit); of
  // receivers without triangles the nearest such. None where the surface has no receivers.
  std::optional<ReceiverWeights> find(Vec3f position, Vec3f normal) const;

 private:
  ReceiverSurface surface_;
  double reach_;  // metres
};

}  // namespace chiaro::inverse
