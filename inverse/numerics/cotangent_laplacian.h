#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace chiaro::inverse::numerics {

// Discrete Laplace–Beltrami operator of a function on the vertices of a triangle mesh, eq. (3.4):
//   Δf(p_i) = 1/A(p_i) Σ_j ½ (cot α_ij + cot β_ij) (f(p_j) − f(p_i)),
// with the mixed area A: circumcentric (Voronoi) in non-obtuse triangles, and in obtuse ones half the triangle at the
// obtuse corner and a quarter at the others. On a boundary edge only the one angle counts. Vertices without area give
// 0. Triangles of zero area are left out. Positions in metres; the result is in units of f per m². Source: Meyer,
// Desbrun, Schröder, Barr, Discrete Differential-Geometry Operators for Triangulated 2-Manifolds, 2003.
std::vector<double> cotangent_laplacian(std::span<const Eigen::Vector3d> positions,
                                        std::span<const std::array<std::uint32_t, 3>> triangles,
                                        std::span<const double> f);

// The mixed areas A(p_i), m²; they sum to the mesh's area.
std::vector<double> mixed_areas(std::span<const Eigen::Vector3d> positions,
                                std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace chiaro::inverse::numerics
