#include "renderer/io/gltf_skins.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "renderer/core/world_limits.h"
#include "renderer/io/gltf_accessors.h"
#include "renderer/io/gltf_nodes.h"
#include "renderer/io/mesh_vertices.h"

namespace chiaro::renderer {
namespace {

constexpr double kRoundingOfInverses = 1e-3;
constexpr float kRoundingOfSums = 0.02F;  // of four weights of 8 bits, generously

std::string attribute_place(const GltfPrimitiveRef& ref, const std::string& name) {
  return fmt::format("{}.attributes.{}", place_of(ref), name);
}

// Four of a vertex's influences.
struct InfluenceSet {
  std::vector<Vec4f> joints, weights;
};

std::vector<InfluenceSet> read_influences(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  std::vector<InfluenceSet> sets;
  for (int n = 0;; ++n) {
    const std::string joints = fmt::format("JOINTS_{}", n), weights = fmt::format("WEIGHTS_{}", n);
    const bool has_joints = find_attribute(document, ref, joints) >= 0;
    if (has_joints != (find_attribute(document, ref, weights) >= 0)) {
      fail(document, place_of(ref), fmt::format("has one of {} and {}", joints, weights), "both or none");
    }
    if (!has_joints) return sets;
    sets.push_back({read_vec4_attribute(document, ref, joints), read_vec4_attribute(document, ref, weights)});
  }
}

class Blend {
 public:
  Blend(const GltfDocument& document, const GltfPrimitiveRef& ref, const std::vector<Mat4f>& joints)
      : document_(document), ref_(ref), joints_(joints), sets_(read_influences(document, ref)) {}

  // World transform of a vertex.
  Mat4f transform(std::size_t vertex) {
    std::array<double, 16> sum{};
    double total = 0, bad = 0;
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      const Vec4f w = sets_[s].weights[vertex], j = sets_[s].joints[vertex];
      for (const auto& [weight, joint] : {std::pair{w.x, j.x}, {w.y, j.y}, {w.z, j.z}, {w.w, j.w}}) {
        if (!(weight >= 0) || !std::isfinite(weight)) ++bad;
        if (!(weight > 0) || !std::isfinite(weight)) continue;
        add(sum, joint_at(vertex, s, joint), weight);
        total += weight;
      }
    }
    if (total == 0) add(sum, joint_at(vertex, 0, sets_[0].joints[vertex].x), total = 1), ++bad;
    if (bad > 0 || std::abs(total - 1) > kRoundingOfSums) ++mended_;
    Mat4f blended;
    for (std::size_t i = 0; i < 16; ++i) blended.m[i] = float(sum[i] / total);
    return blended;
  }

  std::size_t mended() const { return mended_; }

 private:
  const Mat4f& joint_at(std::size_t vertex, std::size_t set, float joint) const {
    if (joint >= 0 && joint < float(joints_.size())) return joints_[std::size_t(joint)];
    fail(document_, attribute_place(ref_, fmt::format("JOINTS_{}", set)),
         fmt::format("vertex {} has joint {}", vertex, joint),
         fmt::format("less than {}, as the skin has", joints_.size()));
  }

  static void add(std::array<double, 16>& sum, const Mat4f& joint, double weight) {
    for (std::size_t i = 0; i < 16; ++i) sum[i] += weight * joint.m[i];
  }

  const GltfDocument& document_;
  const GltfPrimitiveRef& ref_;
  const std::vector<Mat4f>& joints_;
  std::vector<InfluenceSet> sets_;
  std::size_t mended_ = 0;
};

// Where all three corners are mirrored, or two of them.
void turn_mirrored(std::vector<Triangle>& triangles, const std::vector<bool>& mirrored) {
  for (Triangle& t : triangles) {
    if (int(mirrored[t[0]]) + int(mirrored[t[1]]) + int(mirrored[t[2]]) >= 2) std::swap(t[1], t[2]);
  }
}

}  // namespace

std::vector<Mat4f> world_from_bind(const GltfDocument& document, int skin, const std::vector<Mat4f>& world_from_nodes) {
  const GltfSkin& source = document.json.skins[std::size_t(skin)];
  const std::string place = fmt::format("skins[{}]", skin);
  std::vector<float> inverse_bind;
  if (source.inverse_bind_matrices >= 0) {
    inverse_bind = read_floats(document, source.inverse_bind_matrices, 16, place + ".inverseBindMatrices");
    if (inverse_bind.size() < 16 * source.joints.size()) {
      fail(document, place + ".inverseBindMatrices", fmt::format("has {} matrices", inverse_bind.size() / 16),
           fmt::format("{}, one per joint", source.joints.size()));
    }
  }
  std::vector<Mat4f> transforms(source.joints.size());
  for (std::size_t j = 0; j < transforms.size(); ++j) {
    transforms[j] = world_from_nodes[std::size_t(source.joints[j])];
    if (inverse_bind.empty()) continue;
    const auto matrix = inverse_bind.begin() + std::ptrdiff_t(16 * j);
    check_affine(document, {matrix, matrix + 16}, kRoundingOfInverses,
                 fmt::format("{}.inverseBindMatrices[{}]", place, j));
    Mat4f bind;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column)
        bind(row, column) = inverse_bind[16 * j + std::size_t(4 * column + row)];
    }
    transforms[j] = transforms[j] * bind;
    if (!is_finite(transforms[j]))
      fail(document, place, fmt::format("joint {} has a transform that is not finite", j), "finite numbers");
  }
  return transforms;
}

bool has_joints(const GltfDocument& document, const GltfPrimitiveRef& ref) {
  return find_attribute(document, ref, "JOINTS_0") >= 0 || find_attribute(document, ref, "WEIGHTS_0") >= 0;
}

std::size_t skin_mesh(const GltfDocument& document, const GltfPrimitiveRef& ref,
                      const std::vector<Mat4f>& world_from_bind, Mesh& mesh) {
  Blend blend(document, ref, world_from_bind);
  std::vector<bool> mirrored(mesh.positions.size(), false);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Mat4f transform = blend.transform(v);
    mirrored[v] = determinant3(transform) < 0;
    move_vertex(mesh, v, transform, mirrored[v]);
    const Vec3f at = mesh.positions[v];
    if (!in_world(at)) {
      fail(document, place_of(ref), fmt::format("its skin puts vertex {} at {:g}, {:g}, {:g}", v, at.x, at.y, at.z),
           fmt::format("within {:g} m of the origin", kWorldLimit));
    }
  }
  turn_mirrored(mesh.triangles, mirrored);
  return blend.mended();
}

}  // namespace chiaro::renderer
