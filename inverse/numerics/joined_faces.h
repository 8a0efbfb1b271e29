#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "inverse/numerics/surface_contact.h"

namespace chiaro::inverse::numerics {

// Two triangles that meet along a segment without sharing it as an edge.
struct TriangleContact {
  std::uint32_t a = 0, b = 0;
  ContactSegment segment;
};

struct JoinTolerances {
  double same_point = 0;  // corners ≤ this apart are one point
  double contact = 0;     // surfaces ≤ this apart meet; not less than same_point
};

// Triangles as convex faces that share points and whole edges wherever they meet.
struct JoinedFaces {
  struct Face {
    std::uint32_t triangle = 0;
    std::vector<std::uint32_t> points;  // counter-clockwise, as the triangle's corners; ≥ 3
  };
  std::vector<Eigen::Vector3d> points;
  std::vector<Face> faces;              // pieces of a triangle follow one another
  std::vector<std::uint32_t> point_of;  // of each position
  std::vector<std::uint32_t>
      same_triangle;  // of each triangle: that whose faces stand for it, or ~0 where it has no area
};

// Welds corners, leaves out triangles without area and second copies, cuts triangles along contacts, and ends edges
// where a corner of another triangle lies on them (T-junctions).
JoinedFaces join_faces(std::span<const Eigen::Vector3d> positions,
                       std::span<const std::array<std::uint32_t, 3>> triangles,
                       std::span<const TriangleContact> contacts, const JoinTolerances& tolerances);

}  // namespace chiaro::inverse::numerics
