#include "inverse/transport/split_edges.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::Triangle;
using renderer::Vec3f;

SurfaceMesh surface(const renderer::Mesh& mesh) { return {mesh.positions, mesh.normals, mesh.triangles}; }

std::vector<SurfaceMesh> samples() {
  SurfaceMesh needle{{{0, 0, 0}, {10, 0, 0}, {0, 0.1F, 0}}, std::vector<Vec3f>(3, Vec3f{0, 0, 1}), {{0, 1, 2}}};
  return {surface(test::rectangle({0, 0, 0}, {3, 0, 0}, {0, 1, 0})), surface(test::sphere({1, 2, 3}, 1.5F, 6)),
          surface(test::sphere({0, 0, 0}, 1, 9, true)), needle};
}

float longest_edge(const SurfaceMesh& mesh) {
  float longest = 0;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, length(mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]));
    }
  }
  return longest;
}

Vec3f twice_area(const SurfaceMesh& mesh, const Triangle& t) {
  return cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
}

double area(const SurfaceMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += 0.5 * double(length(twice_area(mesh, t)));
  return sum;
}

// How often each directed edge is drawn.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edge_uses(const SurfaceMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  return uses;
}

TEST(SplitEdges, LeavesNoLongEdgeAndKeepsTheArea) {
  for (const SurfaceMesh& before : samples()) {
    for (const float limit : {2.0F, 0.5F, 0.13F}) {
      SurfaceMesh after = before;
      split_long_edges(after, limit);
      EXPECT_LE(longest_edge(after), limit);
      EXPECT_NEAR(area(after), area(before), 1e-5 * area(before));
      ASSERT_EQ(after.positions.size(), after.normals.size());
      for (const Vec3f n : after.normals) EXPECT_NEAR(length(n), 1, 1e-5F);
    }
  }
}

TEST(SplitEdges, KeepsTheOldVerticesFirst) {
  for (const SurfaceMesh& before : samples()) {
    SurfaceMesh after = before;
    split_long_edges(after, 0.3F);
    ASSERT_GT(after.positions.size(), before.positions.size());
    for (std::size_t i = 0; i < before.positions.size(); ++i) {
      EXPECT_EQ(after.positions[i], before.positions[i]);
      EXPECT_EQ(after.normals[i], before.normals[i]);
    }
  }
}

TEST(SplitEdges, ClosedSurfacesStayClosed) {
  // Every directed edge once, and once the other way round: no crack, no overlap, no turned triangle. The test's sphere
  // has its poles as rows of vertices in one place, so a box whose sides share vertices is used.
  SurfaceMesh box;
  for (int i = 0; i < 8; ++i) box.positions.push_back({i & 1 ? 3.0F : 0.0F, i & 2 ? 1.0F : 0.0F, i & 4 ? 0.7F : 0.0F});
  for (const Vec3f p : box.positions) box.normals.push_back(normalize(p - Vec3f{1.5F, 0.5F, 0.35F}));
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const float limit : {1.0F, 0.4F, 0.11F}) {
    SurfaceMesh after = box;
    split_long_edges(after, limit);
    const auto uses = edge_uses(after);
    for (const auto& [edge, count] : uses) {
      ASSERT_EQ(count, 1);
      ASSERT_EQ(uses.count({edge.second, edge.first}), 1U);
    }
    const auto triangles = after.triangles.size(), vertices = after.positions.size(), edges = uses.size() / 2;
    EXPECT_EQ(vertices + triangles, edges + 2);  // Euler
    // The volume of the box, by the divergence theorem, and so no triangle turned.
    double volume = 0;
    for (const Triangle& t : after.triangles) volume += double(dot(after.positions[t[0]], twice_area(after, t))) / 6;
    EXPECT_NEAR(volume, 3 * 1 * 0.7, 1e-4);
  }
}

TEST(SplitEdges, BlendsNormalsAndSurvivesOppositeOnes) {
  SurfaceMesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}}, {{0, 1, 2}}};
  split_long_edges(mesh, 2.5F);  // the longest edge alone, between vertices 1 and 2
  ASSERT_EQ(mesh.positions.size(), 4U);
  EXPECT_EQ(mesh.positions[3], (Vec3f{1, 1, 0}));
  EXPECT_NEAR(mesh.normals[3].x, std::sqrt(0.5F), 1e-5F);
  EXPECT_NEAR(mesh.normals[3].z, -std::sqrt(0.5F), 1e-5F);
  split_long_edges(mesh, 1.5F);
  for (const Vec3f n : mesh.normals) EXPECT_NEAR(length(n), 1, 1e-5F);
}

// Triangles of all shapes: sheared, obtuse, needles long and short, in a row.
SurfaceMesh random_triangles() {
  SurfaceMesh mesh;
  for (std::uint32_t i = 0; i < 200; ++i) {
    renderer::Sampler s(1, 0, i);
    const float height = std::exp2(-8 * s.next_1d()), shear = 2 * s.next_1d() - 0.5F, x = 3 * float(i);
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x + shear, height, 0.3F * height}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.normals.assign(mesh.positions.size(), Vec3f{0, 0, 1});
  return mesh;
}

TEST(SplitEdges, CountIsThatOfTheVerticesMade) {
  std::vector<SurfaceMesh> all = samples();
  all.push_back(random_triangles());
  for (const SurfaceMesh& before : all) {
    for (const float max_edge : {1.7F, 0.5F, 0.13F, 0.05F, 0.03F}) {
      SurfaceMesh after = before;
      split_long_edges(after, max_edge);
      const auto made = double(after.positions.size());
      EXPECT_NEAR(vertices_after_split(before, max_edge, 1e9), made, 1e-3 * made) << max_edge;
    }
  }
}

TEST(SplitEdges, CountingEndsBeyondTheLimit) {
  // Some 1e15 vertices: never to be counted one by one.
  for (const SurfaceMesh& mesh : samples()) EXPECT_GT(vertices_after_split(mesh, 1e-7F, 1e6), 1e6);
  const SurfaceMesh vast = surface(test::rectangle({0, 0, 0}, {3e38F, 0, 0}, {0, 3e38F, 0}));
  EXPECT_GT(vertices_after_split(vast, 1e-7F, 1e6), 1e6);
}

// Between neighbours among floats there is no middle, and edges that stay as long as they are would be split for ever.
TEST(SplitEdges, EndsWhereFloatsHaveNothingBetween) {
  const float far = 1e6F, next = std::nextafter(far, 2 * far);
  SurfaceMesh sliver{{{far, 0, 0}, {next, 0, 0}, {far, 0.01F, 0}}, std::vector<Vec3f>(3, Vec3f{0, 0, 1}), {{0, 1, 2}}};
  split_long_edges(sliver, 0.02F);
  EXPECT_EQ(sliver.positions.size(), 3U);
}

}  // namespace
}  // namespace chiaro::inverse
