#include "renderer/io/mikktspace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/image/image_file.h"
#include "renderer/io/load_gltf.h"
#include "renderer/io/mesh_tangents.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

void expect_tangent(Vec4f t, Vec3f direction, float sign, float tolerance = 1e-6F) {
  EXPECT_NEAR(t.x, direction.x, tolerance);
  EXPECT_NEAR(t.y, direction.y, tolerance);
  EXPECT_NEAR(t.z, direction.z, tolerance);
  EXPECT_EQ(t.w, sign);
}

const std::vector<Vec3f> kUp4(4, Vec3f{0, 0, 1});
const std::vector<Vec3f> kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<Triangle> kTwoTriangles{{0, 1, 2}, {0, 2, 3}};

TEST(Mikktspace, TangentsPointAlongGrowingU) {
  const std::vector<Vec2f> uv{{0, 0}, {2, 0}, {2, 5}, {0, 5}};
  for (const Vec4f& t : mikktspace_tangents(kSquare, kUp4, uv, kTwoTriangles)) expect_tangent(t, {1, 0, 0}, 1);
  const std::vector<Vec2f> turned{{0, 1}, {0, 0}, {1, 0}, {1, 1}};
  for (const Vec4f& t : mikktspace_tangents(kSquare, kUp4, turned, kTwoTriangles)) expect_tangent(t, {0, 1, 0}, 1);
}

TEST(Mikktspace, MirroredCoordinatesHaveTheOtherSign) {
  const std::vector<Vec2f> uv{{1, 0}, {0, 0}, {0, 1}, {1, 1}};
  for (const Vec4f& t : mikktspace_tangents(kSquare, kUp4, uv, kTwoTriangles)) expect_tangent(t, {-1, 0, 0}, -1);
}

// Around the vertex at the origin a face of angle 90° with its u along +X, and one of 45° with its u along +Y: their
// tangents are weighted by the angles.
TEST(Mikktspace, FacesCountByTheirAngle) {
  const std::vector<Vec3f> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  // Face 0: u = x, v = y. Face 1 continues across the edge (0, 2): at vertex 2 u = 0, v = 1; u grows along +Y on it if
  // that edge has u growing, so that the vertex is split in uv but for the origin.
  const std::vector<Vec3f> split{p[0], p[1], p[2], p[0], p[2], p[3]};
  const std::vector<Vec2f> uv{{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {1, 1}};
  const std::vector<Vec3f> up(6, Vec3f{0, 0, 1});
  const std::vector<Vec4f> apart = mikktspace_tangents(split, up, uv, {{0, 1, 2}, {3, 4, 5}});
  // No edge is shared, as the ends at vertex 2 differ in uv: the tangents stay apart.
  expect_tangent(apart[0], {1, 0, 0}, 1);
  expect_tangent(apart[3], {0, 1, 0}, 1);

  // Now both faces have the same uv at both ends of their edge, and bend there: u along (1, 0) on one, and on the
  // other, whose third corner has u = −1, v = 2, d(u, v): u = x, v = y − ... solved below.
  const std::vector<Vec2f> shared{{0, 0}, {1, 0}, {0, 1}, {-2, 1}};
  const std::vector<Vec3f> up4(4, Vec3f{0, 0, 1});
  const std::vector<Vec4f> joined = mikktspace_tangents(p, up4, shared, {{0, 1, 2}, {0, 2, 3}});
  // Face 1: (0,1) has uv (0,1), (−1,1) has (−2,1): u = 2x and v = y, so that its u direction is +X as well.
  expect_tangent(joined[0], {1, 0, 0}, 1);

  // Sheared: third corner (−1,1) has uv (−1, 2), so u = x, v = y − x; the direction of growing u at constant v is
  // (1, 1) / √2. Mean at the origin: 90° of (1, 0) and 45° of (1, 1) / √2.
  const std::vector<Vec2f> sheared{{0, 0}, {1, 0}, {0, 1}, {-1, 2}};
  const std::vector<Vec4f> bent = mikktspace_tangents(p, up4, sheared, {{0, 1, 2}, {0, 2, 3}});
  const float h = std::sqrt(0.5F);
  const Vec3f mean = normalize(Vec3f{2 + h, h, 0});
  expect_tangent(bent[0], mean, 1);
  expect_tangent(bent[3], mean, 1);
  expect_tangent(bent[1], {1, 0, 0}, 1);  // a corner of face 0 alone
  expect_tangent(bent[5], {h, h, 0}, 1);  // a corner of face 1 alone
  // At vertex 2 the angles are 45° and 90°.
  expect_tangent(bent[2], normalize(Vec3f{1 + 2 * h, 2 * h, 0}), 1);
}

TEST(Mikktspace, VerticesOfTheSameValuesAreOneWhateverTheirIndex) {
  const std::vector<Vec3f> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  const std::vector<Vec2f> uv{{0, 0}, {1, 0}, {0, 1}, {-1, 2}};
  const std::vector<Vec3f> up(6, Vec3f{0, 0, 1});
  const std::vector<Vec4f> welded = mikktspace_tangents(p, kUp4, uv, {{0, 1, 2}, {0, 2, 3}});
  const std::vector<Vec4f> unwelded =
      mikktspace_tangents({p[0], p[1], p[2], {-0.0F, 0, 0}, p[2], p[3]}, up, {uv[0], uv[1], uv[2], uv[0], uv[2], uv[3]},
                          {{0, 1, 2}, {3, 4, 5}});
  for (std::size_t c = 0; c < 6; ++c) expect_tangent(unwelded[c], {welded[c].x, welded[c].y, welded[c].z}, welded[c].w);
}

TEST(Mikktspace, MirroredHalvesDoNotShareTangentsAlongTheirSeam) {
  // Left and right of x = 0 u grows away from the seam; positions, normals and uv on the seam are the same.
  const std::vector<Vec3f> p{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}};
  const std::vector<Vec2f> uv{{0, 0}, {0, 1}, {1, 0}, {1, 0}};
  const std::vector<Vec4f> t = mikktspace_tangents(p, kUp4, uv, {{0, 2, 1}, {0, 1, 3}});
  expect_tangent(t[0], {1, 0, 0}, 1);
  expect_tangent(t[3], {-1, 0, 0}, -1);

  Mesh mesh;
  mesh.positions = p;
  mesh.normals = kUp4;
  mesh.uv[0] = uv;
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
  make_tangents(mesh, 0);
  ASSERT_EQ(mesh.positions.size(), 6U);  // both ends of the seam twice
  ASSERT_EQ(mesh.tangents.size(), 6U);
  for (std::size_t f = 0; f < 2; ++f) {
    for (const std::uint32_t v : mesh.triangles[f]) {
      EXPECT_EQ(mesh.tangents[v].x, f == 0 ? 1 : -1);
      EXPECT_EQ(mesh.tangents[v].w, f == 0 ? -1 : 1);  // glTF's bitangent points up, where v shrinks
    }
  }
}

TEST(Mikktspace, FacesWithoutCoordinatesTakeTheirNeighboursTangent) {
  const std::vector<Vec2f> uv{{0, 0}, {0, 1}, {1, 1}, {1, 1}};  // the second face has no area in uv
  const std::vector<Vec4f> t = mikktspace_tangents(kSquare, kUp4, uv, kTwoTriangles);
  expect_tangent(t[0], {0, 1, 0}, -1);
  expect_tangent(t[3], {0, 1, 0}, -1);
  const std::vector<Vec2f> none(4, Vec2f{0.5F, 0.5F});
  for (const Vec4f& alone : mikktspace_tangents(kSquare, kUp4, none, kTwoTriangles)) {
    EXPECT_EQ(alone.x, 1);
    EXPECT_EQ(std::abs(alone.w), 1);
  }
}

TEST(Mikktspace, OnASphereTangentsFollowTheMeridians) {
  // Longitude and latitude as uv: the tangent is the direction east, the exact derivative.
  constexpr int kAround = 64, kUpwards = 32;
  std::vector<Vec3f> p;
  std::vector<Vec2f> uv;
  std::vector<Triangle> triangles;
  for (int j = 0; j <= kUpwards; ++j) {
    for (int i = 0; i <= kAround; ++i) {
      const float phi = 2 * kPi * float(i) / kAround, theta = kPi * (0.1F + 0.8F * float(j) / kUpwards);
      p.push_back({std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)});
      uv.push_back({float(i) / kAround, float(j) / kUpwards});
      if (i == kAround || j == kUpwards) continue;
      const auto a = std::uint32_t(j * (kAround + 1) + i), b = a + 1, c = a + kAround + 1, d = c + 1;
      triangles.push_back({a, c, b});
      triangles.push_back({b, c, d});
    }
  }
  const std::vector<Vec4f> t = mikktspace_tangents(p, p, uv, triangles);
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = triangles[f][c];
      const float phi = 2 * kPi * uv[v].x;
      const Vec3f east{-std::sin(phi), 0, -std::cos(phi)};
      const bool on_seam = uv[v].x == 0 || uv[v].x == 1;
      expect_tangent(t[3 * f + c], east, -1, on_seam ? 0.06F : 0.02F);
    }
  }
}

TEST(NormalMaps, LoadedMeshesHaveTangentsWhereAMaterialNeedsThem) {
  GltfBuilder gltf = triangle_scene();
  gltf.primitive()["attributes"]["NORMAL"] = gltf.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3, kFloat);
  gltf.primitive()["attributes"]["TEXCOORD_3"] = gltf.add_accessor<float>({0, 1, 0, 0, 1, 1}, 2, kFloat);
  gltf.root["images"] = {{{"uri", "flat.png"}}};
  gltf.root["textures"] = {{{"source", 0}}};
  gltf.root["materials"] = {{{"normalTexture", {{"index", 0}, {"texCoord", 3}}}}, ordered_json::object()};
  const TemporaryFolder folder;
  Image flat = make_image(1, 1, {"R", "G", "B"});
  flat.pixels = {0.5F, 0.5F, 1};
  save_image(flat, folder / "flat.png", PixelType::kUint8);
  const auto tangents = [&] { return load_gltf(folder.write("scene.glb", gltf.glb())).scene.meshes.at(0).tangents; };
  EXPECT_TRUE(tangents().empty());
  gltf.primitive()["material"] = 1;
  EXPECT_TRUE(tangents().empty());
  gltf.primitive()["material"] = 0;
  // uv goes from (0, 1) to (0, 0) along x, and to (1, 1) along y.
  ASSERT_EQ(tangents().size(), 3U);
  for (const Vec4f& t : tangents()) expect_tangent(t, {0, 1, 0}, -1);
}

}  // namespace
}  // namespace chiaro::renderer::tests
