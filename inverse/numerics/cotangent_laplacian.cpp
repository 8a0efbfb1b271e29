// The cotangent Laplacian with mixed areas.
// Source: M. Meyer, M. Desbrun, P. Schröder, A. H. Barr, Discrete Differential-Geometry Operators for Triangulated
// 2-Manifolds, Visualization and Mathematics III, 2003: equation (8) and figure 4; thesis eq. (3.4).

#include "inverse/numerics/cotangent_laplacian.h"

#include <algorithm>
#include <stdexcept>

#include <Eigen/Geometry>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;

// A triangle has no area when |edge × edge| ≤ kZeroArea × (longest edge)²: float rounding alone makes as much.
constexpr double kZeroArea = 1e-7;

struct Corners {
  double area = 0;                          // 0: left out
  std::array<double, 3> cotangent{};        // of the angle at each corner
  std::array<double, 3> opposite_square{};  // squared length of the edge opposite to each corner
};

Corners measure(std::span<const Vector3d> positions, const Triangle& triangle) {
  const std::array<const Vector3d*, 3> p{&positions[triangle[0]], &positions[triangle[1]], &positions[triangle[2]]};
  Corners corners;
  for (int i = 0; i < 3; ++i) corners.opposite_square[i] = (*p[(i + 2) % 3] - *p[(i + 1) % 3]).squaredNorm();
  const double twice_area = (*p[1] - *p[0]).cross(*p[2] - *p[0]).norm();
  if (!(twice_area > kZeroArea * *std::ranges::max_element(corners.opposite_square))) return corners;
  corners.area = 0.5 * twice_area;
  for (int i = 0; i < 3; ++i) {
    corners.cotangent[i] = (*p[(i + 1) % 3] - *p[i]).dot(*p[(i + 2) % 3] - *p[i]) / twice_area;
  }
  return corners;
}

// Figure 4 of Meyer et al.: what the corner has of the triangle's area.
double mixed_area(const Corners& corners, int corner) {
  const auto& cotangent = corners.cotangent;
  if (std::ranges::any_of(cotangent, [](double c) { return c < 0; })) {
    return corners.area * (cotangent[corner] < 0 ? 0.5 : 0.25);
  }
  const int next = (corner + 1) % 3, last = (corner + 2) % 3;  // eq. (7), this triangle's part
  return (corners.opposite_square[next] * cotangent[next] + corners.opposite_square[last] * cotangent[last]) / 8;
}

void check_triangles(std::size_t vertex_count, std::span<const Triangle> triangles) {
  for (const Triangle& triangle : triangles) {
    if (*std::ranges::max_element(triangle) >= vertex_count) {
      throw std::invalid_argument("cotangent_laplacian: a triangle uses a vertex that does not exist");
    }
  }
}

}  // namespace

std::vector<double> cotangent_laplacian(std::span<const Vector3d> positions, std::span<const Triangle> triangles,
                                        std::span<const double> f) {
  if (f.size() != positions.size()) {
    throw std::invalid_argument("cotangent_laplacian: one value per vertex is needed");
  }
  check_triangles(positions.size(), triangles);
  std::vector<double> sum(positions.size(), 0.0), area(positions.size(), 0.0);
  for (const Triangle& triangle : triangles) {
    const Corners corners = measure(positions, triangle);
    if (corners.area == 0) continue;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[(i + 1) % 3], b = triangle[(i + 2) % 3];  // the edge opposite to corner i
      const double flow = 0.5 * corners.cotangent[i] * (f[b] - f[a]);            // eq. (8)
      sum[a] += flow;
      sum[b] -= flow;
      area[triangle[i]] += mixed_area(corners, i);
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = area[i] > 0 ? sum[i] / area[i] : 0;
  return sum;
}

std::vector<double> mixed_areas(std::span<const Vector3d> positions, std::span<const Triangle> triangles) {
  check_triangles(positions.size(), triangles);
  std::vector<double> area(positions.size(), 0.0);
  for (const Triangle& triangle : triangles) {
    const Corners corners = measure(positions, triangle);
    if (corners.area == 0) continue;
    for (int i = 0; i < 3; ++i) area[triangle[i]] += mixed_area(corners, i);
  }
  return area;
}

}  // namespace chiaro::inverse::numerics
