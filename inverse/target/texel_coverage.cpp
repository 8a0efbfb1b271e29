#include "inverse/target/texel_coverage.h"

#include <algorithm>
#include <cmath>

namespace chiaro::inverse {
namespace {

using renderer::Box3f;
using renderer::Mesh;
using renderer::Vec2f;

constexpr double kOnEdge = 1e-6;   // texels outside a triangle that still count as in it, or less
constexpr float kInside = 0.05F;   // texels inside two triangles that make them overlap, or more
constexpr float kRounding = 0.5F;  // texels that coordinates may leave the picture by, or less
constexpr double kFlat = 1e-3;     // texels of height, or less: a line but for the rounding of its coordinates

// Texels around the edges of a box.
int first_texel(float edge, int count) { return std::clamp(int(std::floor(edge)) - 1, 0, count); }
int end_texel(float edge, int count) { return std::clamp(int(std::ceil(edge)) + 1, 0, count); }

bool leaves(const Box3f& box, const TexelLayout& layout) {
  return !(box.min.x >= -kRounding && box.min.y >= -kRounding && box.max.x <= float(layout.width) + kRounding &&
           box.max.y <= float(layout.height) + kRounding);
}

// A texel in several triangles is that one's in which it lies deepest.
void add(TexelCover& known, TexelCover cover) {
  cover.overlapping = known.overlapping || (known.mesh >= 0 && std::min(known.depth, cover.depth) >= kInside);
  if (known.mesh < 0 || cover.depth > known.depth) {
    known = cover;
  } else {
    known.overlapping = cover.overlapping;
  }
}

void add_triangle(const FlatTriangle& flat, const TexelLayout& layout, TexelCover cover, TexelCoverage& coverage) {
  const Box3f box = flat.bounds();
  if (leaves(box, layout)) {
    ++coverage.triangles_outside;
    return;
  }
  if (!(flat.height() > kFlat)) return;
  for (int y = first_texel(box.min.y, layout.height); y < end_texel(box.max.y, layout.height); ++y) {
    for (int x = first_texel(box.min.x, layout.width); x < end_texel(box.max.x, layout.width); ++x) {
      const double depth = flat.depth(flat.at(x + 0.5, y + 0.5));
      if (depth < -kOnEdge) continue;
      cover.depth = float(depth);
      add(coverage.texels[std::size_t(y) * std::size_t(layout.width) + std::size_t(x)], cover);
    }
  }
}

}  // namespace

FlatTriangle::FlatTriangle(const Mesh& mesh, std::uint32_t triangle, const TexelLayout& layout) {
  for (int k = 0; k < 3; ++k) {
    const Vec2f uv = mesh.uv[std::size_t(layout.uv_set)][mesh.triangles[triangle][k]];
    x_[k] = double(uv.x) * layout.width;
    y_[k] = double(uv.y) * layout.height;
  }
}

Box3f FlatTriangle::bounds() const {
  Box3f box;
  for (int k = 0; k < 3; ++k) box.extend({float(x_[k]), float(y_[k]), 0});
  return box;
}

Barycentric FlatTriangle::at(double x, double y) const {
  const double twice = 2 * signed_area();
  return {cross(1, 2, x, y) / twice, cross(2, 0, x, y) / twice, cross(0, 1, x, y) / twice};
}

double FlatTriangle::height() const {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    longest = std::max(longest, std::hypot(x_[next] - x_[k], y_[next] - y_[k]));
  }
  return longest > 0 ? 2 * std::abs(signed_area()) / longest : 0;
}

double FlatTriangle::depth(const Barycentric& at) const {
  double depth = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const double height = 2 * std::abs(signed_area()) / std::hypot(x_[b] - x_[a], y_[b] - y_[a]);
    depth = std::min(depth, at[k] * height);
  }
  return depth;
}

TexelCoverage cover_texels(const renderer::Scene& scene, std::span<const int> meshes, const TexelLayout& layout) {
  TexelCoverage coverage;
  coverage.texels.resize(std::size_t(layout.width) * std::size_t(layout.height));
  for (const int mesh : meshes) {
    const Mesh& shown = scene.meshes[std::size_t(mesh)];
    for (std::uint32_t t = 0; t < shown.triangles.size(); ++t) {
      add_triangle(FlatTriangle(shown, t, layout), layout, {.mesh = mesh, .triangle = t}, coverage);
    }
  }
  return coverage;
}

}  // namespace chiaro::inverse
