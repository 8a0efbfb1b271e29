#include "renderer/io/load_gltf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/image/image_file.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

using renderer::load_gltf;
using renderer::LoadedScene;
using renderer::Mesh;
using renderer::Vec3f;

LoadedScene load(const GltfBuilder& gltf) {
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.glb", gltf.glb()));
}

void expect_near(Vec3f a, Vec3f b, float tolerance = 1e-6F) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

bool mentions(const std::vector<std::string>& lines, const std::string& part) {
  for (const std::string& line : lines) {
    if (line.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(GltfAccessors, StridedPositionsAndNormalsShareABufferView) {
  GltfBuilder gltf;
  const std::vector<float> interleaved{0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0, 1};
  const int view = gltf.add_view(bytes_of(interleaved), 24);
  const ordered_json common = {{"bufferView", view}, {"componentType", kFloat}, {"count", 3}, {"type", "VEC3"}};
  ordered_json normals = common;
  normals["byteOffset"] = 12;
  gltf.add_mesh({{"POSITION", gltf.add_accessor(common)}, {"NORMAL", gltf.add_accessor(normals)}});
  gltf.add_node({{"mesh", 0}});
  const LoadedScene loaded = load(gltf);
  const Mesh& mesh = loaded.scene.meshes.at(0);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
}

TEST(GltfAccessors, NormalizedIntegersBecomeFractions) {
  GltfBuilder gltf = triangle_scene();
  const int uv = gltf.add_accessor<std::uint16_t>({0, 65535, 32768, 0, 65535, 65535}, 2, kUnsignedShort, true);
  const int color =
      gltf.add_accessor<std::uint8_t>({255, 0, 51, 255, 0, 255, 0, 102, 0, 0, 0, 0}, 4, kUnsignedByte, true);
  gltf.primitive()["attributes"]["TEXCOORD_0"] = uv;
  gltf.primitive()["attributes"]["COLOR_0"] = color;
  const LoadedScene loaded = load(gltf);
  const Mesh& mesh = loaded.scene.meshes.at(0);
  EXPECT_FLOAT_EQ(mesh.uv[0].at(0).y, 1);
  EXPECT_FLOAT_EQ(mesh.uv[0].at(1).x, 32768.0F / 65535);
  EXPECT_FLOAT_EQ(mesh.colors.at(0).z, 0.2F);
  EXPECT_FLOAT_EQ(mesh.colors.at(1).w, 0.4F);
  EXPECT_TRUE(mesh.uv[1].empty());
}

TEST(LoadGltf, InstancesBelongToTheNodesAboveThem) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0]["name"] = "leaf";
  gltf.add_node({{"children", {0}}});
  gltf.add_node({{"name", "tree"}, {"children", {1}}});
  gltf.add_node({{"name", "stone"}});
  const Scene scene = load(gltf).scene;
  for (const char* name : {"leaf", "node 1", "tree"})
    EXPECT_TRUE(belongs_to(scene, scene.instances.at(0), name)) << name;
  for (const char* name : {"", "stone", "node 0"}) EXPECT_FALSE(belongs_to(scene, scene.instances.at(0), name)) << name;
}

TEST(GltfAccessors, SignedNormalizedIntegersReachMinusOne) {
  GltfBuilder gltf;
  const int positions = gltf.add_accessor<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}, 4, kShort, true);
  gltf.root["accessors"][0]["type"] = "VEC3";
  gltf.root["bufferViews"][0]["byteStride"] = 8;
  gltf.add_mesh({{"POSITION", positions}});
  gltf.add_node({{"mesh", 0}});
  const LoadedScene loaded = load(gltf);
  EXPECT_EQ(loaded.scene.meshes.at(0).positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}));
}

TEST(GltfAccessors, SparseValuesReplaceThoseOfTheBase) {
  GltfBuilder gltf = triangle_scene();
  const int indices = gltf.add_view(bytes_of<std::uint8_t>({1, 2}));
  const int values = gltf.add_view(bytes_of<float>({5, 0, 0, 0, 7, 0}));
  gltf.root["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(load(gltf).scene.meshes.at(0).positions, (std::vector<Vec3f>{{0, 0, 0}, {5, 0, 0}, {0, 7, 0}}));
}

TEST(GltfAccessors, WithoutABufferViewTheBaseIsZero) {
  GltfBuilder gltf = triangle_scene();
  const int indices = gltf.add_view(bytes_of<std::uint16_t>({1, 2}));
  const int values = gltf.add_view(bytes_of<float>({5, 0, 0, 0, 7, 0}));
  gltf.root["accessors"][0].erase("bufferView");
  gltf.root["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(load(gltf).scene.meshes.at(0).positions, (std::vector<Vec3f>{{0, 0, 0}, {5, 0, 0}, {0, 7, 0}}));
}

struct ModeCase {
  const char* name;
  int mode;
  std::size_t triangles;
};

class GltfModes : public testing::TestWithParam<ModeCase> {};

TEST_P(GltfModes, TrianglesFaceTheSameWay) {
  GltfBuilder gltf;
  // A fan's and a strip's order of the same square differ.
  const std::vector<float> strip{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, fan{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  gltf.add_mesh({{"POSITION", gltf.add_accessor(GetParam().mode == 6 ? fan : strip, 3, kFloat)}});
  gltf.primitive()["mode"] = GetParam().mode;
  gltf.add_node({{"mesh", 0}});
  const LoadedScene loaded = load(gltf);
  EXPECT_EQ(renderer::drawn_triangle_count(loaded.scene), GetParam().triangles);
  EXPECT_EQ(mentions(loaded.warnings, "without triangles"), GetParam().triangles == 0);
  for (const Mesh& mesh : loaded.scene.meshes) {
    for (const Vec3f& normal : mesh.normals) expect_near(normal, {0, 0, 1});
  }
}

INSTANTIATE_TEST_SUITE_P(AllModes, GltfModes,
                         testing::Values(ModeCase{"Points", 0, 0}, ModeCase{"Lines", 1, 0}, ModeCase{"LineLoop", 2, 0},
                                         ModeCase{"LineStrip", 3, 0}, ModeCase{"Triangles", 4, 1},
                                         ModeCase{"TriangleStrip", 5, 2}, ModeCase{"TriangleFan", 6, 2}),
                         test::kByName);

TEST(GltfMeshes, WithoutNormalsTrianglesGetVerticesOfTheirOwn) {
  GltfBuilder gltf;
  gltf.add_mesh({{"POSITION", gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3, kFloat)}});
  gltf.primitive()["indices"] = gltf.add_accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, 1, kUnsignedByte);
  gltf.add_node({{"mesh", 0}});
  const LoadedScene loaded = load(gltf);
  const Mesh& mesh = loaded.scene.meshes.at(0);
  ASSERT_EQ(mesh.positions.size(), 6U);
  expect_near(mesh.normals[0], {0, 0, 1});
  expect_near(mesh.normals[5], {1, 0, 0});
}

TEST(GltfMeshes, TrianglesWithoutAreaAreDroppedAndCounted) {
  GltfBuilder gltf;
  const int positions = gltf.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0}, 3, kFloat);
  const int normals = gltf.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0, 1}, 3, kFloat);
  gltf.add_mesh({{"POSITION", positions}, {"NORMAL", normals}});
  gltf.primitive()["indices"] = gltf.add_accessor<std::uint32_t>({0, 1, 2, 0, 1, 3, 1, 1, 2}, 1, kUnsignedInt);
  gltf.add_node({{"mesh", 0}});
  const LoadedScene loaded = load(gltf);
  const Mesh& mesh = loaded.scene.meshes.at(0);
  EXPECT_EQ(mesh.triangles, (std::vector<renderer::Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh.positions.size(), 3U) << "the vertex that only the dropped triangle used is gone";
  expect_near(mesh.normals[2], {0, 0, 1});
  EXPECT_TRUE(mentions(loaded.warnings, "2 triangles of zero area"));
}

TEST(LoadGltf, CornersThatMakeNoTriangleAreLeftOutWithAWarning) {
  GltfBuilder gltf = triangle_scene();
  gltf.primitive()["indices"] = gltf.add_accessor<std::uint8_t>({0, 1, 2, 0, 1}, 1, kUnsignedByte);
  const LoadedScene loaded = load(gltf);
  EXPECT_EQ(loaded.scene.meshes.at(0).triangles.size(), 1U);
  EXPECT_TRUE(mentions(loaded.warnings, "2 corners at the ends of lists make no triangle"));
}

TEST(GltfMeshes, NormalsWithoutDirectionAreReplaced) {
  GltfBuilder gltf = triangle_scene();
  const float nan = std::nanf("");
  gltf.primitive()["attributes"]["NORMAL"] = gltf.add_accessor<float>({0, 0, 0, nan, 0, 0, 0, 0, -3}, 3, kFloat);
  const LoadedScene loaded = load(gltf);
  const Mesh& mesh = loaded.scene.meshes.at(0);
  expect_near(mesh.normals[0], {0, 0, 1});
  expect_near(mesh.normals[1], {0, 0, 1});
  expect_near(mesh.normals[2], {0, 0, -1});
  EXPECT_TRUE(mentions(loaded.warnings, "2 normals"));
}

TEST(GltfMeshes, NodesShareTheMeshesOfTheirPrimitives) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0]["name"] = "first";
  gltf.add_node({{"mesh", 0}, {"translation", {1, 2, 3}}});
  const LoadedScene loaded = load(gltf);
  EXPECT_EQ(loaded.scene.meshes.size(), 1U);
  ASSERT_EQ(loaded.scene.instances.size(), 2U);
  EXPECT_EQ(loaded.scene.instances[0].name, "first");
  EXPECT_EQ(loaded.scene.instances[1].name, "node 1");
  EXPECT_EQ(loaded.scene.instances[1].mesh, 0);
  EXPECT_EQ(loaded.scene.materials.at(loaded.scene.meshes[0].material).base_color, (Vec3f{1, 1, 1}));
}

TEST(GltfNodes, TranslationRotationScaleEqualTheirMatrix) {
  GltfBuilder gltf = triangle_scene();
  const double h = std::sqrt(0.5);  // a quarter turn around Y
  gltf.root["nodes"][0] = {{"mesh", 0}, {"translation", {1, 2, 3}}, {"rotation", {0, h, 0, h}}, {"scale", {2, 3, 4}}};
  gltf.add_node({{"mesh", 0}, {"matrix", {0, 0, -2, 0, 0, 3, 0, 0, 4, 0, 0, 0, 1, 2, 3, 1}}});
  const LoadedScene loaded = load(gltf);
  for (int i = 0; i < 16; ++i) {
    EXPECT_NEAR(loaded.scene.instances.at(0).world_from_object.m[i],
                loaded.scene.instances.at(1).world_from_object.m[i], 1e-6F);
  }
  expect_near(transform_point(loaded.scene.instances[0].world_from_object, {1, 0, 0}), {1, 2, 1});
}

TEST(GltfNodes, ParentsApplyAfterChildrenAndMayMirror) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0] = {{"mesh", 0}, {"translation", {1, 0, 0}}};
  gltf.add_node({{"children", {0}}, {"scale", {-2, 1, 1}}});
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.scene.instances.size(), 1U);
  expect_near(transform_point(loaded.scene.instances[0].world_from_object, {1, 0, 0}), {-4, 0, 0});
  EXPECT_LT(determinant3(loaded.scene.instances[0].world_from_object), 0);
}

TEST(GltfNodes, OnlyOneSceneIsShown) {
  GltfBuilder gltf = triangle_scene();
  gltf.add_node({{"mesh", 0}, {"name", "shown"}});
  gltf.root["scenes"] = ordered_json::array({{{"nodes", {0}}}, {{"nodes", {1}}}});
  gltf.root.erase("scene");
  EXPECT_EQ(load(gltf).scene.instances.size(), 1U) << "the first, where none is named";
  gltf.root["scene"] = 1;
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.scene.instances.size(), 1U);
  EXPECT_EQ(loaded.scene.instances[0].name, "shown");
  gltf.root.erase("scene");
  gltf.root.erase("scenes");
  EXPECT_EQ(load(gltf).scene.instances.size(), 2U) << "all nodes, where there are no scenes";
}

TEST(GltfNodes, CopiesWithoutVolumeAreLeftOut) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0]["scale"] = {0, 0, 0};
  const LoadedScene loaded = load(gltf);
  EXPECT_TRUE(loaded.scene.instances.empty());
  EXPECT_TRUE(mentions(loaded.warnings, "1 instance scaled to nothing"));
}

// Nodes that share the positions of their instances, of which nothing is in the file.
TEST(GltfNodes, InstancesAreAsManyAsThereIsDataForAndAMillion) {
  GltfBuilder gltf = triangle_scene();
  const int accessor = gltf.add_accessor({{"componentType", kFloat}, {"count", 65000}, {"type", "VEC3"}});
  const ordered_json instancing{{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", accessor}}}}}};
  for (int i = 0; i < 16; ++i) gltf.add_node({{"mesh", 0}, {"extensions", instancing}});
  EXPECT_EQ(load(gltf).scene.instances.size(), 1040001U);
  gltf.add_node({{"mesh", 0}, {"extensions", instancing}});
  const std::string message = error_of([&] { load(gltf); });
  EXPECT_NE(message.find("nodes[17]: makes 1105001 instances of what is in the file (expected at most 10"),
            std::string::npos)
      << message;
}

TEST(GltfNodes, WhereFloatsAreCoarseIsToldOrRefused) {
  for (const auto& [away, told] : {std::pair(1e3, false), std::pair(2e4, true)}) {
    GltfBuilder gltf = triangle_scene();
    gltf.root["nodes"][0]["translation"] = {0, 0, away};
    EXPECT_EQ(mentions(load(gltf).warnings, "from the origin, where positions are"), told) << away;
  }
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0]["translation"] = {0, 0, 1e6};
  EXPECT_THROW(load(gltf), Error);
}

TEST(GltfNodes, AScaleOfZeroAcrossAFlatMeshLeavesItAsItIs) {
  GltfBuilder gltf = triangle_scene();
  const LoadedScene whole = load(gltf);
  gltf.root["nodes"][0]["scale"] = {1, 1, 0};
  const LoadedScene flat = load(gltf);
  ASSERT_EQ(flat.scene.instances.size(), 1U);
  EXPECT_FALSE(mentions(flat.warnings, "scaled to nothing"));
  const auto world = [](const Scene& scene) {
    const Instance& instance = scene.instances[0];
    std::vector<Vec3f> positions, normals;
    for (const Vec3f p : scene.meshes[std::size_t(instance.mesh)].positions)
      positions.push_back(transform_point(instance.world_from_object, p));
    for (const Vec3f n : scene.meshes[std::size_t(instance.mesh)].normals)
      normals.push_back(transform_normal(instance.world_from_object, n));
    return std::pair(positions, normals);
  };
  EXPECT_EQ(world(flat.scene), world(whole.scene));
  // Where the zero is along the triangle nothing is left.
  gltf.root["nodes"][0]["scale"] = {0, 1, 1};
  EXPECT_TRUE(load(gltf).scene.instances.empty());
}

TEST(GltfNodes, ScalesBeyondAllMeasureAreErrorsAndNotNothing) {
  GltfBuilder gltf = triangle_scene();
  for (const double scale : {1e10, 1e15, 1e30, -1e15}) {
    gltf.root["nodes"][0]["scale"] = {scale, scale, scale};
    try {
      load(gltf);
      ADD_FAILURE() << scale;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("nodes[0]: puts a vertex at"), std::string::npos) << error.what();
    }
  }
}

TEST(GltfNodes, GpuInstancingMultipliesANode) {
  GltfBuilder gltf = triangle_scene();
  const int translations = gltf.add_accessor<float>({0, 0, 0, 5, 0, 0}, 3, kFloat);
  gltf.root["nodes"][0] = {
      {"mesh", 0},
      {"scale", {2, 2, 2}},
      {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", translations}}}}}}}};
  gltf.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.scene.instances.size(), 2U);
  expect_near(transform_point(loaded.scene.instances[1].world_from_object, {1, 0, 0}), {12, 0, 0});
}

TEST(GltfNodes, GpuInstancingByAttributesOfOthersAlone) {
  GltfBuilder gltf = triangle_scene();
  const int numbers = gltf.add_accessor<float>({1, 2, 3}, 1, kFloat);
  gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["_ID"] = numbers;
  gltf.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  EXPECT_EQ(load(gltf).scene.instances.size(), 3U);
}

TEST(GltfCameras, ScaleAndMirroringLeaveTheAxesOrthonormal) {
  GltfBuilder gltf;
  gltf.root["cameras"] = ordered_json::array(
      {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
       {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 1}, {"znear", 0}, {"zfar", 10}}}}});
  gltf.add_node({{"camera", 0}, {"name", "shot"}});
  gltf.add_node({{"children", {0}}, {"scale", {-0.01, 0.01, 0.01}}, {"translation", {1, 2, 3}}});
  gltf.add_node({{"camera", 1}});
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.scene.cameras.size(), 2U);
  const renderer::Camera& shot =
      loaded.scene.cameras[1].name == "shot" ? loaded.scene.cameras[1] : loaded.scene.cameras[0];
  EXPECT_EQ(shot.name, "shot");
  EXPECT_FLOAT_EQ(shot.vertical_fov, 0.8F);
  EXPECT_FLOAT_EQ(shot.aspect_ratio, 1.5F);
  EXPECT_NEAR(determinant3(shot.world_from_camera), 1, 1e-5F);
  expect_near(shot.world_from_camera.column(3), {1, 2, 3});
  const renderer::Camera& other = &shot == &loaded.scene.cameras[0] ? loaded.scene.cameras[1] : loaded.scene.cameras[0];
  EXPECT_TRUE(other.orthographic);
  EXPECT_FLOAT_EQ(other.half_width, 2);
  EXPECT_EQ(other.name, "camera 1");
}

// A frame's header has a matrix of them, which must be numbers.
TEST(GltfCameras, PlanesBeyondTheWorldAreNoneOrRefused) {
  const auto with_planes = [](double near, double far) {
    GltfBuilder gltf;
    gltf.root["cameras"] = ordered_json::array(
        {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", near}, {"zfar", far}}}}});
    gltf.add_node({{"camera", 0}});
    return load(gltf).scene.cameras[0];
  };
  EXPECT_EQ(with_planes(0.1, 3e38).far, kInfinity);
  EXPECT_EQ(with_planes(0.1, 1e6).far, 1e6F);
  EXPECT_THROW(with_planes(3e38, 3.4e38), Error);
}

TEST(GltfLights, ArePlacedByTheirNodes) {
  GltfBuilder gltf;
  gltf.root["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = ordered_json::array(
      {{{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}, {"range", 5}},
       {{"type", "spot"}, {"name", "beam"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.3}}}},
       {{"type", "directional"}, {"intensity", 3}}});
  const auto light = [](int index) { return ordered_json{{"KHR_lights_punctual", {{"light", index}}}}; };
  const double h = std::sqrt(0.5);  // a quarter turn around X: -Z becomes +Y
  gltf.add_node({{"name", "lamp"}, {"translation", {1, 2, 3}}, {"extensions", light(0)}});
  gltf.add_node({{"rotation", {h, 0, 0, h}}, {"scale", {3, 3, 3}}, {"extensions", light(1)}});
  gltf.add_node({{"extensions", light(2)}});
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.lights.size(), 3U);
  const auto& lamp = std::get<renderer::PointLight>(loaded.lights[0]);
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_EQ(lamp.position, (Vec3f{1, 2, 3}));
  EXPECT_EQ(lamp.intensity, (Vec3f{10, 5, 0}));
  const auto& beam = std::get<renderer::SpotLight>(loaded.lights[1]);
  EXPECT_EQ(beam.name, "beam");
  expect_near(beam.direction, {0, 1, 0});
  EXPECT_FLOAT_EQ(beam.outer_cone_angle, 0.3F);
  EXPECT_EQ(beam.intensity, (Vec3f{1, 1, 1}));
  expect_near(std::get<renderer::DirectionalLight>(loaded.lights[2]).direction, {0, 0, -1});
  EXPECT_TRUE(mentions(loaded.warnings, "range of 1 light is ignored"));
}

TEST(GltfMaterials, FactorsTexturesAndAlphaComeThrough) {
  const TemporaryFolder folder;
  renderer::Image image = renderer::make_image(2, 1, {"R", "G", "B"});
  image.pixels = {1, 0, 0, 0, 1, 0};
  save_image(image, folder / "two texels.png", renderer::PixelType::kUint8);
  GltfBuilder gltf = triangle_scene();
  gltf.root["images"] = ordered_json::array({{{"uri", "two%20texels.png"}}, {{"uri", "not used, not there.png"}}});
  gltf.root["samplers"] = ordered_json::array({{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}});
  gltf.root["textures"] = ordered_json::array({{{"source", 0}, {"sampler", 0}}, {{"source", 0}}, {{"source", 1}}});
  gltf.root["materials"] =
      ordered_json::array({{{"name", "painted"},
                            {"pbrMetallicRoughness",
                             {{"baseColorFactor", {0.5, 0.25, 1, 0.75}},
                              {"metallicFactor", 0},
                              {"roughnessFactor", 0.5},
                              {"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}},
                            {"emissiveTexture", {{"index", 1}, {"texCoord", 9}}},
                            {"emissiveFactor", {1, 0.5, 0}},
                            {"alphaMode", "MASK"},
                            {"alphaCutoff", 0.25},
                            {"doubleSided", true},
                            {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 200}}}}}}});
  gltf.primitive()["material"] = 0;
  const LoadedScene loaded = load_gltf(folder.write("scene.glb", gltf.glb()));
  const renderer::Material& material = loaded.scene.materials.at(0);
  EXPECT_EQ(material.name, "painted");
  EXPECT_EQ(material.base_color, (Vec3f{0.5F, 0.25F, 1}));
  EXPECT_FLOAT_EQ(material.alpha, 0.75F);
  EXPECT_FLOAT_EQ(material.roughness, 0.5F);
  EXPECT_EQ(material.emission, (Vec3f{200, 100, 0}));
  EXPECT_EQ(material.alpha_mode, renderer::AlphaMode::kMask);
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.base_color_texture.uv_set, 1);
  EXPECT_EQ(material.emission_texture.uv_set, 0);
  EXPECT_TRUE(mentions(loaded.warnings, "TEXCOORD_9"));
  ASSERT_EQ(loaded.scene.textures.size(), 2U) << "one image, sampled in two ways";
  const renderer::Texture& texture = loaded.scene.textures[std::size_t(material.base_color_texture.texture)];
  EXPECT_EQ(texture.rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255}));
  EXPECT_TRUE(texture.nearest);
  EXPECT_EQ(texture.wrap_u, renderer::Wrap::kClampToEdge);
  EXPECT_EQ(texture.wrap_v, renderer::Wrap::kMirroredRepeat);
}

TEST(GltfMaterials, ImagesWithTheSameBytesAreOne) {
  const TemporaryFolder folder;
  save_image(renderer::make_image(1, 1, {"R", "G", "B"}), folder / "one.png", renderer::PixelType::kUint8);
  save_image(renderer::make_image(2, 1, {"R", "G", "B"}), folder / "two.png", renderer::PixelType::kUint8);
  GltfBuilder gltf = triangle_scene();
  const ordered_json one = {{"uri", "one.png"}, {"name", "again"}}, two = {{"uri", "two.png"}};
  gltf.root["images"] = ordered_json::array({{{"uri", "one.png"}}, two, one, one});
  gltf.root["textures"] = ordered_json::array({{{"source", 0}}, {{"source", 1}}, {{"source", 2}}, {{"source", 3}}});
  gltf.root["materials"] = ordered_json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                                 {"emissiveTexture", {{"index", 3}}},
                                                 {"emissiveFactor", {1, 1, 1}}},
                                                {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}},
                                                 {"emissiveTexture", {{"index", 2}}},
                                                 {"emissiveFactor", {1, 1, 1}}}});
  const LoadedScene loaded = load_gltf(folder.write("scene.glb", gltf.glb()));
  ASSERT_EQ(loaded.scene.textures.size(), 2U);
  for (const int width : {1, 2}) {
    const renderer::Material& material = loaded.scene.materials.at(std::size_t(width - 1));
    EXPECT_EQ(loaded.scene.textures[std::size_t(material.base_color_texture.texture)].width, width);
    EXPECT_EQ(loaded.scene.textures[std::size_t(material.emission_texture.texture)].width, 1);
  }
}

// They nest nothing.
TEST(LoadGltf, BracketsInNamesAreOfNoDepth) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.root["nodes"][0]["name"] = std::string(600, '[') + "\"\\" + std::string(600, '{');
  EXPECT_EQ(load_gltf(folder.write("scene.glb", gltf.glb())).scene.instances.size(), 1U);
}

TEST(GltfMaterials, TexturesWhoseCoordinatesAMeshHasNotAreTold) {
  const TemporaryFolder folder;
  save_image(renderer::make_image(1, 1, {"R", "G", "B"}), folder / "black.png", renderer::PixelType::kUint8);
  GltfBuilder gltf = triangle_scene();
  gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.add_accessor<float>({0, 0, 1, 0, 0, 1}, 2, kFloat);
  gltf.root["meshes"][0]["name"] = "wall";
  gltf.root["images"] = ordered_json::array({{{"uri", "black.png"}}});
  gltf.root["textures"] = ordered_json::array({{{"source", 0}}});
  gltf.root["materials"] = ordered_json::array(
      {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
        {"emissiveFactor", {1, 1, 1}},
        {"emissiveTexture", {{"index", 0}, {"texCoord", 3}}},
        {"extensions",
         {{"KHR_materials_transmission",
           {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}, {"texCoord", 1}}}}}}}}});
  gltf.primitive()["material"] = 0;
  gltf.add_node({{"mesh", 0}, {"scale", {1, 1, 0}}});  // a mesh of its own in the scene, of the same material
  const std::string file = (folder / "scene.glb").string();
  const std::vector<std::string> expected{
      file + ": materials[0].emissiveTexture: mesh \"wall\" has no TEXCOORD_3; the texture is not read there",
      file +
          ": materials[0].extensions.KHR_materials_transmission.transmissionTexture: mesh \"wall\" has no TEXCOORD_1; "
          "the "
          "texture is not read there"};
  std::vector<std::string> told = load_gltf(folder.write("scene.glb", gltf.glb())).warnings;
  std::erase_if(told, [](const std::string& line) { return line.find("TEXCOORD") == std::string::npos; });
  EXPECT_EQ(told, expected);
  gltf.primitive()["attributes"].erase("TEXCOORD_0");
  EXPECT_TRUE(mentions(load_gltf(folder.write("scene.glb", gltf.glb())).warnings, "baseColorTexture"));
}

TEST(GltfMaterials, CoordinatesOfNoSuchNumberAreRefused) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["textures"] = ordered_json::array({ordered_json::object()});
  gltf.root["materials"] = ordered_json::array({{{"normalTexture", {{"index", 0}, {"texCoord", 1e10}}}}});
  const std::string message = error_of([&] { load(gltf); });
  EXPECT_NE(message.find("materials[0].normalTexture.texCoord: is 10000000000 (expected at most 1e+09)"),
            std::string::npos)
      << message;
}

TEST(GltfBuffers, DataUrisAndFilesWithSpacesAreRead) {
  const TemporaryFolder folder;
  const GltfBuilder gltf = triangle_scene();
  folder.write("my buffer.bin", gltf.binary + "more than byteLength");
  ordered_json root = gltf.root;
  root["buffers"] = ordered_json::array({{{"byteLength", 36}, {"uri", "my%20buffer.bin"}}});
  EXPECT_EQ(load_gltf(folder.write("a.gltf", root.dump())).scene.meshes.size(), 1U);
  for (const std::string head : {"data:application/octet-stream;base64,", "DATA:;Base64,"}) {
    root["buffers"][0]["uri"] = head + "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    const LoadedScene loaded = load_gltf(folder.write("b.gltf", root.dump()));
    EXPECT_EQ(loaded.scene.meshes.at(0).positions[1], (Vec3f{1, 0, 0})) << head;
  }
}

TEST(GltfExtensions, UsedOnesThatAreNotReadWarnOnce) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["extensionsUsed"] = {"KHR_materials_iridescence", "KHR_xmp"};
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_TRUE(mentions(loaded.warnings, "KHR_materials_iridescence"));
}

}  // namespace
}  // namespace chiaro::renderer::tests
