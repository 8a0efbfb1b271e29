#pragma once
// Animations of a glTF file, at one time.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/io/gltf_document.h"

namespace chiaro::renderer {

// Which animation, and when. Without a time nothing moves: nodes stand as the file has them.
struct AnimationChoice {
  std::string animation;          // name, or index where none has that name; empty: see pose_at
  std::optional<double> seconds;  // before the first key and after the last, that key holds
};

// What animations set of a node; the rest is as in the file.
struct NodePose {
  std::optional<Vec3f> translation, scale;
  std::optional<Vec4f> rotation;  // unit quaternion x, y, z, w
  std::vector<float> weights;     // of morph targets; empty: not set
};

using GltfPose = std::map<int, NodePose>;  // by node

// The pose at the time chosen; empty without one. Where no animation is named, all of the file play together if no two
// of them move the same thing, else the first alone, with a warning. STEP, LINEAR (spherical for rotations) and
// CUBICSPLINE, as glTF 2.0, appendix C, has them. Error for an animation that is not there, and for keys that are
// malformed.
GltfPose pose_at(const GltfDocument& document, const AnimationChoice& choice, std::vector<std::string>& warnings);

}  // namespace chiaro::renderer
