#pragma once
// Which triangle of a texture layout the centre of each texel lies in.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/scene/scene.h"

namespace chiaro::inverse {

using Barycentric = std::array<double, 3>;

struct TexelLayout {
  int width = 0, height = 0;
  int uv_set = 0;  // that all meshes have
};

// A triangle in the picture, u to the right and v down; lengths in texels.
class FlatTriangle {
 public:
  FlatTriangle(const renderer::Mesh& mesh, std::uint32_t triangle, const TexelLayout& layout);

  double signed_area() const { return cross(0, 1, x_[2], y_[2]) / 2; }
  renderer::Box3f bounds() const;  // z: 0
  Barycentric at(double x, double y) const;
  double height() const;                      // over its longest edge
  double depth(const Barycentric& at) const;  // to the nearest edge; negative outside

 private:
  double cross(int a, int b, double x, double y) const {
    return (x_[b] - x_[a]) * (y - y_[a]) - (y_[b] - y_[a]) * (x - x_[a]);
  }

  std::array<double, 3> x_{}, y_{};
};

struct TexelCover {
  int mesh = -1;  // index into Scene::meshes; -1: the centre lies in no triangle
  std::uint32_t triangle = 0;
  float depth = 0;           // of the centre in the triangle, texels
  bool overlapping = false;  // it lies in others as well, and not only on their edges
};

struct TexelCoverage {
  std::vector<TexelCover> texels;     // rows from v = 0
  std::size_t triangles_outside = 0;  // whose coordinates leave 0 to 1 by more than half a texel: left out
};

TexelCoverage cover_texels(const renderer::Scene& scene, std::span<const int> meshes, const TexelLayout& layout);

}  // namespace chiaro::inverse
