#include "inverse/numerics/geodesic_distance.h"

#include <gtest/gtest.h>

#include "tests/inverse/numerics/walkable_surface.h"

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector3d;
using tests::distances_to;
using tests::make_flat_sheet;
using tests::Soup;

constexpr double kPi = 3.14159265358979323846;

struct Worst {
  double error = 0;
  Vector3d place = Vector3d::Zero();
  int compared = 0;
};

// The largest difference to a closed form where that is within 0.98 of the reach, in parts of the reach.
template <class Expected>
Worst worst_error(const Soup& soup, const std::vector<double>& found, double reach, const Expected& expected) {
  Worst worst;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double exact = expected(soup.positions[i]);
    if (exact > 1.02 * reach) {
      EXPECT_GT(found[i], reach) << soup.positions[i].transpose();
    }
    if (exact > 0.98 * reach) continue;
    ++worst.compared;
    const double error = std::abs(found[i] - exact) / reach;
    if (error >= worst.error) worst.error = error, worst.place = soup.positions[i];
  }
  return worst;
}

struct Mesh {
  const char* name;
  int columns, rows;
  double jitter;
};

// Regular, irregular, with thin triangles; coarser and finer than the brush.
constexpr Mesh kMeshes[] = {{"coarse", 4, 4, 0},       {"irregular", 14, 13, 0.48}, {"thin", 3, 60, 0.48},
                            {"thinner", 2, 150, 0.48}, {"fine", 90, 90, 0.48},      {"fine regular", 80, 80, 0}};

double distance_to_segment(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  return (a + closest_on_segment(a, b, p) * (b - a) - p).norm();
}

Soup plane(const Mesh& mesh) {
  return make_flat_sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, mesh.columns, mesh.rows, mesh.jitter);
}

TEST(GeodesicDistance, OnAPlaneIsStraightWhateverTheTriangles) {
  for (const Mesh& mesh : kMeshes) {
    SCOPED_TRACE(mesh.name);
    const Soup soup = plane(mesh);
    const Vector3d at(0.437, 0.519, 0);
    const Worst worst =
        worst_error(soup, distances_to(soup, at, at, 0.6), 0.6, [&](const Vector3d& p) { return (p - at).norm(); });
    EXPECT_LT(worst.error, 0.01) << worst.place.transpose();
    EXPECT_GT(worst.compared, 10);
  }
}

TEST(GeodesicDistance, FromASegmentIsThatToTheSegment) {
  for (const Mesh& mesh : kMeshes) {
    SCOPED_TRACE(mesh.name);
    const Soup soup = plane(mesh);
    const Vector3d a(0.22, 0.41, 0), b(0.71, 0.63, 0);
    const auto expected = [&](const Vector3d& p) { return distance_to_segment(a, b, p); };
    const Worst worst = worst_error(soup, distances_to(soup, a, b, 0.4), 0.4, expected);
    EXPECT_LT(worst.error, 0.01) << worst.place.transpose();
    EXPECT_GT(worst.compared, 10);
  }
}

TEST(GeodesicDistance, FromAnEdgeOrAVertexTheSame) {
  const Soup soup = plane(kMeshes[0]);
  for (const Vector3d& at :
       {Vector3d(0.25, 0.5, 0), Vector3d(0.375, 0.5, 0), Vector3d(0, 0, 0), Vector3d(0.375, 0.375, 0)}) {
    const Worst worst =
        worst_error(soup, distances_to(soup, at, at, 0.8), 0.8, [&](const Vector3d& p) { return (p - at).norm(); });
    EXPECT_LT(worst.error, 1e-6) << at.transpose();
  }
}

// On the lines of a fine mesh, whose vertices windows do not get to alone.
TEST(GeodesicDistance, FromAnEdgeOrAVertexOfAFineMeshTheSame) {
  for (const int cells : {32, 64}) {
    const Soup soup = plane({"fine", cells, cells, 0});
    for (const Vector3d& at : {Vector3d(0.5, 0.5, 0), Vector3d(0.515625, 0.5, 0), Vector3d(0.40625, 0.40625, 0),
                               Vector3d(0, 0, 0), Vector3d(0, 0.25, 0)}) {
      const Worst worst =
          worst_error(soup, distances_to(soup, at, at, 0.6), 0.6, [&](const Vector3d& p) { return (p - at).norm(); });
      EXPECT_LT(worst.error, 1e-3) << cells << " " << at.transpose() << " " << worst.place.transpose();
    }
  }
}

// A floor at x ≥ 0 that faces up, and at x = 0 a wall above it that faces the floor, or one below that faces away.
Soup corner(double up) {
  Soup soup = make_flat_sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 7, 9, 0.48);
  soup.append(make_flat_sheet({0, 0, 0}, {0, 1, 0}, {0, 0, up}, 9, 11, 0.48));
  return soup;
}

TEST(GeodesicDistance, RoundARightAngleIsUnfolded) {
  for (const double up : {1.0, -1.0}) {
    const Soup soup = corner(up);
    const Vector3d at(0.2, 0.45, 0);
    const auto unfolded = [&](const Vector3d& p) { return std::hypot(p.x() - up * p.z() - at.x(), p.y() - at.y()); };
    const Worst worst = worst_error(soup, distances_to(soup, at, at, 0.7), 0.7, unfolded);
    EXPECT_LT(worst.error, 0.003) << up << ": " << worst.place.transpose();
    EXPECT_GT(worst.compared, 60);
  }
}

Soup cylinder(int around, int along, double jitter) {
  return tests::make_sheet(around, along, jitter, [&](double u, double v) {
    return Vector3d(std::cos(2 * kPi * u), std::sin(2 * kPi * u), 2 * v - 1);
  });
}

TEST(GeodesicDistance, OnACylinderIsUnrolled) {
  for (const auto& [around, along] : {std::pair(48, 14), std::pair(64, 64), std::pair(200, 60)}) {
    const Soup soup = cylinder(around, along, 0.48);
    const Vector3d at = soup.positions[std::size_t((around + 1) * (along / 2) + around / 3)];
    const auto unrolled = [&](const Vector3d& p) {
      const double angle = std::remainder(std::atan2(p.y(), p.x()) - std::atan2(at.y(), at.x()), 2 * kPi);
      return std::hypot(angle, p.z() - at.z());
    };
    for (const double reach : {0.5, 1.5}) {
      const Worst worst = worst_error(soup, distances_to(soup, at, at, reach), reach, unrolled);
      EXPECT_LT(worst.error, 0.01) << around << " reach " << reach << ": " << worst.place.transpose();
    }
  }
}

TEST(GeodesicDistance, OnASphereIsTheArc) {
  for (const auto& [around, along] : {std::pair(40, 20), std::pair(64, 64), std::pair(180, 90)}) {
    const Soup soup = tests::make_sheet(around, along, 0, [&](double u, double v) {
      return Vector3d(std::sin(kPi * v) * std::cos(2 * kPi * u), std::sin(kPi * v) * std::sin(2 * kPi * u),
                      std::cos(kPi * v));
    });
    const Vector3d at = soup.positions[std::size_t((around + 1) * (along / 2 - 2) + 3)];
    const auto arc = [&](const Vector3d& p) { return std::acos(std::clamp(p.dot(at), -1.0, 1.0)); };
    for (const double reach : {0.4, 1.2}) {
      const Worst worst = worst_error(soup, distances_to(soup, at, at, reach), reach, arc);
      EXPECT_LT(worst.error, 0.012) << around << " reach " << reach << ": " << worst.place.transpose();
    }
  }
}

// An L of three unit squares without the one at (1, 1).
TEST(GeodesicDistance, BendsRoundTheEndOfASheet) {
  for (const int n : {2, 7, 40}) {
    Soup soup = make_flat_sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n, 0.48);
    soup.append(make_flat_sheet({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n, 0.48));
    soup.append(make_flat_sheet({0, 1, 0}, {1, 0, 0}, {0, 1, 0}, n, n, 0.48));
    const Vector3d at(1.6, 0.8, 0), bend(1, 1, 0);
    const auto expected = [&](const Vector3d& p) {
      const double cross = (p - at).cross(bend - at).z();
      return p.y() > 1 && cross > 0 ? (at - bend).norm() + (p - bend).norm() : (p - at).norm();
    };
    const Worst worst = worst_error(soup, distances_to(soup, at, at, 1.5), 1.5, expected);
    EXPECT_LT(worst.error, 0.006) << n << ": " << worst.place.transpose();
  }
}

}  // namespace
}  // namespace chiaro::inverse::numerics
