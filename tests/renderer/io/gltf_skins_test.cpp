#include "renderer/io/gltf_skins.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/io/load_gltf.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

void expect_near(Vec3f a, Vec3f b, float tolerance = 1e-5F) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

LoadedScene load(const GltfBuilder& gltf) {
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.glb", gltf.glb()));
}

bool mentions(const LoadedScene& loaded, const std::string& part) {
  for (const std::string& line : loaded.warnings) {
    if (line.find(part) != std::string::npos) return true;
  }
  return false;
}

std::vector<float> translation_matrix(float x, float y, float z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

// A triangle at z = 0 whose corners follow joint 0, joint 1, and half of each. Joint 0 was bound at the origin and is
// there; joint 1 was bound at (0, 0, 5) and stands at (0, 0, 8): it moves what it carries by 3 along z. The node of the
// mesh has a transform that skinning leaves out.
GltfBuilder skinned_triangle() {
  GltfBuilder gltf = triangle_scene();
  gltf.primitive()["attributes"]["JOINTS_0"] =
      gltf.add_accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 4, kUnsignedByte);
  gltf.primitive()["attributes"]["WEIGHTS_0"] =
      gltf.add_accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, 4, kFloat);
  gltf.add_node({{"name", "joint 0"}});
  gltf.add_node({{"name", "joint 1"}, {"translation", {0, 0, 8}}});
  std::vector<float> bind = translation_matrix(0, 0, 0);
  const std::vector<float> second = translation_matrix(0, 0, -5);
  bind.insert(bind.end(), second.begin(), second.end());
  const int view = gltf.add_view(bytes_of(bind));
  const int matrices =
      gltf.add_accessor(ordered_json{{"bufferView", view}, {"componentType", kFloat}, {"count", 2}, {"type", "MAT4"}});
  gltf.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
  gltf.root["nodes"][0]["skin"] = 0;
  gltf.root["nodes"][0]["translation"] = {100, 0, 0};
  return gltf;
}

TEST(Skins, VerticesFollowTheirJointsAtRest) {
  const LoadedScene loaded = load(skinned_triangle());
  EXPECT_EQ(loaded.scene.meshes.at(0).positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 3}, {0, 1, 1.5F}}));
  expect_near(transform_point(loaded.scene.instances.at(0).world_from_object, {0, 0, 0}), {0, 0, 0});
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(Skins, WithoutBindMatricesJointsCarryWhatIsAtTheirOrigin) {
  GltfBuilder gltf = skinned_triangle();
  gltf.root["skins"][0].erase("inverseBindMatrices");
  EXPECT_EQ(load(gltf).scene.meshes.at(0).positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 8}, {0, 1, 4}}));
}

TEST(Skins, WeightsOfAllSetsCount) {
  GltfBuilder gltf = skinned_triangle();
  gltf.primitive()["attributes"]["WEIGHTS_0"] =
      gltf.add_accessor<std::uint8_t>({204, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, 4, kUnsignedByte, true);
  gltf.primitive()["attributes"]["JOINTS_1"] =
      gltf.add_accessor<std::uint16_t>({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4, kUnsignedShort);
  gltf.primitive()["attributes"]["WEIGHTS_1"] =
      gltf.add_accessor<std::uint8_t>({51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4, kUnsignedByte, true);
  const LoadedScene loaded = load(gltf);
  expect_near(loaded.scene.meshes.at(0).positions.at(0), {0, 0, 0.6F});
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(Skins, OneMeshWithTwoSkinsIsTwoMeshes) {
  GltfBuilder gltf = skinned_triangle();
  gltf.root["skins"].push_back({{"joints", {2, 1}}});
  gltf.add_node({{"mesh", 0}, {"skin", 1}});
  gltf.add_node({{"mesh", 0}, {"translation", {0, 9, 0}}});
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.scene.meshes.size(), 3U);
  EXPECT_EQ(loaded.scene.meshes[1].positions.at(0), (Vec3f{0, 0, 8}));
  EXPECT_EQ(loaded.scene.meshes[2].positions.at(1), (Vec3f{1, 0, 0}));
  expect_near(loaded.scene.instances.at(2).world_from_object.column(3), {0, 9, 0});
}

TEST(Skins, NormalsAndTangentsTurnWithTheirJoints) {
  GltfBuilder gltf = skinned_triangle();
  gltf.primitive()["attributes"]["NORMAL"] = gltf.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3, kFloat);
  gltf.primitive()["attributes"]["TANGENT"] = gltf.add_accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, 4, kFloat);
  const float h = std::sqrt(0.5F);
  gltf.root["nodes"][2]["rotation"] = {0, h, 0, h};  // +X becomes −Z, +Z becomes +X
  const Mesh mesh = load(gltf).scene.meshes.at(0);
  expect_near(mesh.normals.at(0), {0, 0, 1});
  expect_near(mesh.normals.at(1), {1, 0, 0});
  expect_near({mesh.tangents.at(1).x, mesh.tangents.at(1).y, mesh.tangents.at(1).z}, {0, 0, -1});
}

TEST(Skins, MirroringJointsTurnTrianglesRound) {
  GltfBuilder gltf = skinned_triangle();
  gltf.add_node({{"children", {1, 2}}, {"scale", {-1, 1, 1}}});
  const Mesh mesh = load(gltf).scene.meshes.at(0);
  const Triangle& t = mesh.triangles.at(0);
  const Vec3f normal = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
  EXPECT_GT(normal.z, 0);  // as mirrored instances keep their outside outside
  EXPECT_GT(mesh.normals.at(0).z, 0);
}

TEST(Skins, WeightsThatDoNotAddUpAreMendedWithAWarning) {
  GltfBuilder gltf = skinned_triangle();
  gltf.primitive()["attributes"]["WEIGHTS_0"] =
      gltf.add_accessor<float>({0, 0, 0, 0, 4, 0, 0, 0, NAN, 0.25F, -1, 0}, 4, kFloat);
  const LoadedScene loaded = load(gltf);
  EXPECT_EQ(loaded.scene.meshes.at(0).positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 3}, {0, 1, 3}}));
  EXPECT_TRUE(mentions(loaded, "3 vertices have skin weights"));
}

TEST(Skins, JointsThatAreNotThereAreRefusedByPlace) {
  GltfBuilder gltf = skinned_triangle();
  gltf.primitive()["attributes"]["JOINTS_0"] =
      gltf.add_accessor<std::uint8_t>({0, 0, 0, 0, 7, 0, 0, 0, 0, 9, 0, 0}, 4, kUnsignedByte);
  const std::string message = error_of([&] { load(gltf); });
  EXPECT_NE(message.find("meshes[0].primitives[0].attributes.JOINTS_0: vertex 1 has joint 7 (expected less than 2"),
            std::string::npos)
      << message;
}

TEST(Skins, JointsOutsideTheWorldAreRefused) {
  GltfBuilder gltf = skinned_triangle();
  gltf.root["nodes"][1]["translation"] = {-1e30, 0, 0};
  EXPECT_NE(error_of([&] { load(gltf); }).find("its skin puts vertex 0 at -1e+30, 0, 0 (expected within 1e+09 m"),
            std::string::npos)
      << error_of([&] { load(gltf); });
}

TEST(Skins, TooFewBindMatricesAreRefused) {
  GltfBuilder gltf = skinned_triangle();
  gltf.root["skins"][0]["joints"] = {1, 2, 0};
  EXPECT_NE(error_of([&] { load(gltf); }).find("skins[0].inverseBindMatrices: has 2 matrices"), std::string::npos);
}

TEST(Skins, TransposedBindMatricesAreRefused) {
  GltfBuilder gltf = skinned_triangle();
  const std::vector<float> transposed{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -5, 0, 0, 0, 1};
  std::vector<float> bind = translation_matrix(0, 0, 0);
  bind.insert(bind.end(), transposed.begin(), transposed.end());
  const int view = gltf.add_view(bytes_of(bind));
  gltf.root["skins"][0]["inverseBindMatrices"] =
      gltf.add_accessor(ordered_json{{"bufferView", view}, {"componentType", kFloat}, {"count", 2}, {"type", "MAT4"}});
  EXPECT_NE(error_of([&] { load(gltf); }).find("skins[0].inverseBindMatrices[1]: element 11 is -5"), std::string::npos)
      << error_of([&] { load(gltf); });
}

TEST(Skins, JointsThatAreNoWholeNumbersAreRefused) {
  for (const bool normalized : {false, true}) {
    GltfBuilder gltf = skinned_triangle();
    gltf.primitive()["attributes"]["JOINTS_0"] =
        normalized ? gltf.add_accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 4, kUnsignedByte, true)
                   : gltf.add_accessor<float>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 4, kFloat);
    EXPECT_NE(error_of([&] { load(gltf); }).find("attributes.JOINTS_0: has no whole numbers as they are"),
              std::string::npos);
  }
}

TEST(Skins, JointsWithoutWeightsAreRefused) {
  for (const char* missing : {"JOINTS_0", "WEIGHTS_0"}) {
    GltfBuilder gltf = skinned_triangle();
    gltf.primitive()["attributes"].erase(missing);
    EXPECT_NE(error_of([&] { load(gltf); }).find("has one of JOINTS_0 and WEIGHTS_0"), std::string::npos);
  }
}

TEST(Skins, MeshesWithoutJointsStayWithTheirNode) {
  GltfBuilder gltf = skinned_triangle();
  gltf.primitive()["attributes"].erase("JOINTS_0");
  gltf.primitive()["attributes"].erase("WEIGHTS_0");
  expect_near(load(gltf).scene.instances.at(0).world_from_object.column(3), {100, 0, 0});
}

}  // namespace
}  // namespace chiaro::renderer::tests
