#include "inverse/numerics/cotangent_laplacian.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace chiaro::inverse::numerics {
namespace {

using Eigen::Vector3d;

struct Mesh {
  std::vector<Vector3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<char> interior;

  std::vector<double> map(const std::function<double(const Vector3d&)>& f) const {
    std::vector<double> values;
    for (const Vector3d& p : positions) values.push_back(f(p));
    return values;
  }
  std::vector<double> laplacian(const std::vector<double>& f) const {
    return cotangent_laplacian(positions, triangles, f);
  }
  double area() const {
    double sum = 0;
    for (const auto& t : triangles) {
      sum += 0.5 * (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm();
    }
    return sum;
  }
};

// The square [−1, 1]² in the plane z = 0, its interior vertices moved by up to `jitter` of a cell, and stretched along
// x.
Mesh make_plane(int cells, double jitter, double stretch = 1) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> move(-jitter * 2 / cells, jitter * 2 / cells);
  Mesh mesh;
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      const bool interior = x > 0 && y > 0 && x < cells && y < cells;
      const double dx = interior ? move(random) : 0, dy = interior ? move(random) : 0;
      mesh.positions.emplace_back(stretch * (-1 + 2.0 * x / cells + dx), -1 + 2.0 * y / cells + dy, 0);
      mesh.interior.push_back(interior);
    }
  }
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const auto a = std::uint32_t(y * (cells + 1) + x), b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

Mesh subdivided(const Mesh& mesh, double radius) {
  Mesh fine{mesh.positions, {}, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [place, added] = middles.try_emplace(std::minmax(a, b), std::uint32_t(fine.positions.size()));
    if (added) fine.positions.push_back(radius * (fine.positions[a] + fine.positions[b]).normalized());
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) fine.triangles.push_back(t);
  }
  return fine;
}

Mesh make_sphere(double radius, int subdivisions) {
  Mesh mesh;
  for (const double s : {-radius, radius}) {
    for (int axis = 0; axis < 3; ++axis) mesh.positions.push_back(s * Vector3d::Unit(axis));
  }
  mesh.triangles = {{3, 4, 5}, {4, 0, 5}, {0, 1, 5}, {1, 3, 5}, {4, 3, 2}, {0, 4, 2}, {1, 0, 2}, {3, 1, 2}};
  for (int i = 0; i < subdivisions; ++i) mesh = subdivided(mesh, radius);
  return mesh;
}

int count_obtuse(const Mesh& mesh) {
  int count = 0;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Vector3d &p = mesh.positions[t[i]], &q = mesh.positions[t[(i + 1) % 3]],
                     &r = mesh.positions[t[(i + 2) % 3]];
      count += (q - p).dot(r - p) < 0 ? 1 : 0;
    }
  }
  return count;
}

// ∫ g Δf over the plane, by the operator; g vanishes on the boundary.
double weak_form(const Mesh& mesh, const std::vector<double>& f, const std::vector<double>& g) {
  const std::vector<double> laplacian = mesh.laplacian(f), area = mixed_areas(mesh.positions, mesh.triangles);
  double sum = 0;
  for (std::size_t i = 0; i < f.size(); ++i) sum += area[i] * g[i] * laplacian[i];
  return sum;
}

double squared_radius(const Vector3d& p) { return p.x() * p.x() + p.y() * p.y(); }

TEST(CotangentLaplacian, OfALinearFunctionOnAPlaneIsZeroInside) {
  for (const double stretch : {1.0, 4.0}) {
    const Mesh mesh = make_plane(16, 0.24, stretch);
    const auto laplacian = mesh.laplacian(mesh.map([](const Vector3d& p) { return 3 * p.x() - 2 * p.y() + 7; }));
    for (std::size_t i = 0; i < laplacian.size(); ++i) {
      if (!mesh.interior[i]) continue;
      EXPECT_NEAR(laplacian[i], 0, 1e-9);
    }
  }
}

TEST(CotangentLaplacian, OfTheSquaredRadiusIsFourOnARegularGrid) {
  const Mesh mesh = make_plane(12, 0);
  const auto laplacian = mesh.laplacian(mesh.map(squared_radius));
  for (std::size_t i = 0; i < laplacian.size(); ++i) {
    if (!mesh.interior[i]) continue;
    EXPECT_NEAR(laplacian[i], 4, 1e-10);
  }
}

TEST(CotangentLaplacian, OfTheSquaredRadiusIsFourInTheMeanOnIrregularAndObtuseTriangles) {
  for (const double stretch : {1.0, 3.0}) {
    const Mesh mesh = make_plane(60, 0.24, stretch);
    EXPECT_GT(count_obtuse(mesh), 1000);
    const auto hat = mesh.map([&](const Vector3d& p) {
      const double x = p.x() / stretch;
      return (1 - x * x) * (1 - p.y() * p.y());
    });
    const double integral_of_hat = stretch * 16.0 / 9;
    EXPECT_NEAR(weak_form(mesh, mesh.map(squared_radius), hat) / integral_of_hat, 4, 0.02);
    const std::vector<double> ones(mesh.positions.size(), 1);
    const auto area = mixed_areas(mesh.positions, mesh.triangles), laplacian = mesh.laplacian(mesh.map(squared_radius));
    double sum = 0, inside = 0;
    for (std::size_t i = 0; i < area.size(); ++i) {
      if (mesh.interior[i]) sum += area[i] * laplacian[i], inside += area[i];
    }
    EXPECT_NEAR(sum / inside, 4, 0.08);
  }
}

TEST(CotangentLaplacian, IsASymmetricOperatorInTheMeasureOfTheMixedAreas) {
  const Mesh mesh = make_plane(10, 0.24);
  const auto f = mesh.map([](const Vector3d& p) { return std::sin(3 * p.x()) + p.y(); });
  const auto g = mesh.map([](const Vector3d& p) { return std::exp(p.x() * p.y()); });
  EXPECT_NEAR(weak_form(mesh, f, g), weak_form(mesh, g, f), 1e-12);
  EXPECT_NEAR(weak_form(mesh, f, std::vector<double>(f.size(), 1)), 0, 1e-12);
}

TEST(CotangentLaplacian, OfTheHeightOnASphere) {
  const double radius = 2.5;
  const Mesh mesh = make_sphere(radius, 5);
  const auto laplacian = mesh.laplacian(mesh.map([](const Vector3d& p) { return p.z(); }));
  for (std::size_t i = 0; i < laplacian.size(); ++i) {
    EXPECT_NEAR(laplacian[i], -2 * mesh.positions[i].z() / (radius * radius), 0.04 * 2 / radius);
  }
}

TEST(CotangentLaplacian, MixedAreasSumToTheSurface) {
  for (const Mesh& mesh : {make_plane(20, 0.24), make_plane(20, 0.24, 6), make_sphere(1.5, 4)}) {
    const auto area = mixed_areas(mesh.positions, mesh.triangles);
    EXPECT_GT(*std::min_element(area.begin(), area.end()), 0);
    EXPECT_NEAR(std::accumulate(area.begin(), area.end(), 0.0), mesh.area(), 1e-12 * mesh.area());
  }
  EXPECT_NEAR(make_plane(20, 0.24, 6).area(), 24, 1e-9);
  EXPECT_NEAR(make_sphere(1, 5).area(), 4 * std::numbers::pi, 0.02);
}

TEST(CotangentLaplacian, MixedAreasOfSingleTriangles) {
  const std::vector<std::array<std::uint32_t, 3>> one{{0, 1, 2}};
  const std::vector<Vector3d> equilateral{{0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0}};
  for (const double area : mixed_areas(equilateral, one)) EXPECT_NEAR(area, std::sqrt(3.0) / 3, 1e-14);
  const std::vector<Vector3d> obtuse{{0, 0, 0}, {4, 0, 0}, {2, 0.5, 0}};  // area 1
  const auto area = mixed_areas(obtuse, one);
  EXPECT_NEAR(area[0], 0.25, 1e-14);
  EXPECT_NEAR(area[1], 0.25, 1e-14);
  EXPECT_NEAR(area[2], 0.5, 1e-14);
}

TEST(CotangentLaplacian, VerticesAndTrianglesWithoutAreaGiveZero) {
  const std::vector<Vector3d> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}, {5, 5, 5}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {3, 4, 3}, {0, 0, 0}};
  const std::vector<double> f{1, 5, -2, 8, 3};
  EXPECT_EQ(cotangent_laplacian(positions, triangles, f), std::vector<double>(5, 0.0));
  EXPECT_EQ(mixed_areas(positions, triangles), std::vector<double>(5, 0.0));
  EXPECT_TRUE(cotangent_laplacian({}, {}, {}).empty());
}

TEST(CotangentLaplacian, RefusesVerticesThatDoNotExist) {
  const std::vector<Vector3d> positions(2, Vector3d::Zero());
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  const std::vector<double> f(2, 0.0), too_few(1, 0.0);
  EXPECT_THROW(cotangent_laplacian(positions, triangles, f), std::invalid_argument);
  EXPECT_THROW(mixed_areas(positions, triangles), std::invalid_argument);
  EXPECT_THROW(cotangent_laplacian(positions, {}, too_few), std::invalid_argument);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
