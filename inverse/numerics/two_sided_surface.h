#pragma once

#include "inverse/numerics/geodesic_distance.h"
#include "inverse/numerics/joined_faces.h"

namespace chiaro::inverse::numerics {

// Both sides of every face as one surface, as somebody walks on it: from an edge on to the face that is met first on
// the side walked on. So what stands on a floor is walked up and not walked under, a face is left for its back nowhere
// but round a rim, and the end of a sheet without a back is an end.
// Face i of `surface` is the front of face i (its points counter-clockwise), face i + faces.size() its back.
struct TwoSidedSurface {
  struct Frame {
    Eigen::Vector3d origin, x, y;  // of a front; the y of the back is turned round

    Eigen::Vector2d flat(const Eigen::Vector3d& p) const { return {x.dot(p - origin), y.dot(p - origin)}; }
  };
  FlatSurface surface;
  std::vector<Frame> frames;  // of each face
};

TwoSidedSurface make_two_sided(const JoinedFaces& joined);

}  // namespace chiaro::inverse::numerics
