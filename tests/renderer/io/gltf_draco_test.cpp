#include <draco/compression/expert_encode.h>
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/io/draco_header.h"
#include "renderer/io/load_gltf.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

constexpr int kSide = 12;  // vertices along a side of the grid

Vec3f grid_point(int i) {
  const float x = float(i % kSide), z = float(i / kSide);
  return {x, 0.25F * std::sin(x) * z, z};
}

std::vector<Triangle> grid_triangles() {
  std::vector<Triangle> triangles;
  for (std::uint32_t z = 0; z + 1 < kSide; ++z) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = z * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
      triangles.push_back({a, c, b});
      triangles.push_back({b, c, d});
    }
  }
  return triangles;
}

struct DracoCase {
  const char* name;
  draco::MeshEncoderMethod method;
  bool metadata;
};

template <class T>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type,
                  const std::vector<std::array<T, 3>>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, 3, data_type, std::is_integral_v<T>, 3 * sizeof(T), 0);
  const int id = mesh.AddAttribute(attribute, true, std::uint32_t(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(std::uint32_t(i)), values[i].data());
  }
  return id;
}

std::string encoded_grid(const DracoCase& how) {
  draco::Mesh mesh;
  mesh.set_num_points(kSide * kSide);
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint8_t, 3>> colors;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec3f p = grid_point(i);
    positions.push_back({p.x, p.y, p.z});
    colors.push_back({std::uint8_t(i), std::uint8_t(255 - i), 51});
  }
  add_attribute(mesh, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, positions);
  add_attribute(mesh, draco::GeometryAttribute::COLOR, draco::DT_UINT8, colors);
  for (const Triangle& t : grid_triangles()) {
    mesh.AddFace({draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  if (how.metadata) {
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    metadata->AddEntryString("name", "a grid");
    auto inner = std::make_unique<draco::Metadata>();
    inner->AddEntryInt("size", kSide);
    metadata->AddSubMetadata("inner", std::move(inner));
    mesh.AddMetadata(std::move(metadata));
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(how.method);
  encoder.SetAttributeQuantization(0, 16);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return {buffer.data(), buffer.size()};
}

constexpr DracoCase kEdgebreaker{"Edgebreaker", draco::MESH_EDGEBREAKER_ENCODING, false};

GltfBuilder draco_scene(const std::string& encoded) {
  GltfBuilder gltf;
  const int view = gltf.add_view(encoded);
  const auto unbacked = [&](int type, const char* kind, std::size_t count) {
    return gltf.add_accessor(ordered_json{{"componentType", type}, {"count", count}, {"type", kind}});
  };
  const int positions = unbacked(kFloat, "VEC3", kSide * kSide),
            colors = unbacked(kUnsignedByte, "VEC3", kSide * kSide);
  gltf.root["accessors"][std::size_t(colors)]["normalized"] = true;
  gltf.add_mesh({{"POSITION", positions}, {"COLOR_0", colors}});
  gltf.primitive()["indices"] = unbacked(kUnsignedShort, "SCALAR", 3 * grid_triangles().size());
  gltf.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                  {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
  gltf.add_node({{"mesh", 0}});
  gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return gltf;
}

LoadedScene load(const GltfBuilder& gltf) {
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.glb", gltf.glb()));
}

class Draco : public testing::TestWithParam<DracoCase> {};

TEST_P(Draco, MeshesComeBackWithinTheirQuantisation) {
  const LoadedScene loaded = load(draco_scene(encoded_grid(GetParam())));
  const Mesh& mesh = loaded.scene.meshes.at(0);
  EXPECT_EQ(mesh.triangles.size(), grid_triangles().size());
  ASSERT_EQ(mesh.positions.size(), mesh.colors.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f p = mesh.positions[v];
    const int i = int(std::lround(p.x)) + kSide * int(std::lround(p.z));
    EXPECT_LT(length(p - grid_point(i)), 5e-4F) << i;
    EXPECT_NEAR(mesh.colors[v].x, float(i) / 255, 1e-6F);
    EXPECT_NEAR(mesh.colors[v].z, 0.2F, 1e-6F);
    EXPECT_EQ(mesh.colors[v].w, 1);
  }
  for (const Vec3f& n : mesh.normals) EXPECT_GT(n.y, 0);  // wound as before
}

TEST_P(Draco, TheHeaderTellsTheNumberOfTriangles) {
  const auto sizes = draco_sizes(encoded_grid(GetParam()));
  ASSERT_TRUE(sizes);
  EXPECT_EQ(sizes->faces, grid_triangles().size());
  const bool sequential = GetParam().method == draco::MESH_SEQUENTIAL_ENCODING;
  EXPECT_EQ(sizes->points, sequential ? std::size_t(kSide * kSide) : 0);
}

TEST_P(Draco, DamagedDataAreRefusedOrReadButNeverCrash) {
  const std::string whole = encoded_grid(GetParam());
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = 0; at < whole.size(); at += 13, ++tried) {
    std::string damaged = whole;
    damaged[at] = char(damaged[at] ^ 0x55);
    const std::string message = error_of([&] { load(draco_scene(damaged)); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    refused += message.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, tried / 20);
  for (const std::size_t size : {std::size_t{4}, std::size_t{12}, whole.size() / 2}) {
    EXPECT_NE(error_of([&] { load(draco_scene(whole.substr(0, size))); }).find("meshes[0].primitives[0]"),
              std::string::npos)
        << size;
  }
}

INSTANTIATE_TEST_SUITE_P(Encoders, Draco,
                         testing::Values(kEdgebreaker, DracoCase{"Sequential", draco::MESH_SEQUENTIAL_ENCODING, false},
                                         DracoCase{"EdgebreakerWithMetadata", draco::MESH_EDGEBREAKER_ENCODING, true}),
                         test::kByName);

TEST(DracoPrimitives, AnAttributeThatIsNotInTheDataIsNamed) {
  GltfBuilder gltf = draco_scene(encoded_grid(kEdgebreaker));
  gltf.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["COLOR_0"] = 7;
  EXPECT_NE(error_of([&] { load(gltf); }).find("attribute 7 is not in the data"), std::string::npos);
}

TEST(DracoPrimitives, PrimitivesMayShareAccessorsThatHoldNothing) {
  GltfBuilder gltf = draco_scene(encoded_grid(kEdgebreaker));
  const int view = gltf.add_view(encoded_grid({"", draco::MESH_SEQUENTIAL_ENCODING, false}));
  ordered_json second = gltf.primitive();
  second["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = view;
  gltf.root["meshes"][0]["primitives"].push_back(second);
  EXPECT_EQ(drawn_triangle_count(load(gltf).scene), 2 * grid_triangles().size());
}

TEST(DracoPrimitives, MoreTrianglesThanAnyMemoryHoldsAreRefusedBeforeTheyAreMade) {
  // DRACO, 2.2, mesh, sequential, no flags, 2^31 faces, 3 points.
  std::string bomb("DRACO\x02\x02\x01\x00\x00\x00", 11);
  bomb += std::string("\x80\x80\x80\x80\x08\x03", 6);
  EXPECT_EQ(draco_sizes(bomb)->faces, std::uint64_t{1} << 31);
  EXPECT_NE(error_of([&] { load(draco_scene(bomb)); }).find("says it has 2147483648 triangles"), std::string::npos);
}

TEST(DracoPrimitives, MorePointsThanAnyMemoryHoldsAreRefusedBeforeTheyAreMade) {
  // DRACO, 2.2, mesh, sequential, no flags, one face, 2^31 points.
  std::string bomb("DRACO\x02\x02\x01\x00\x00\x00", 11);
  bomb += std::string("\x01\x80\x80\x80\x80\x08", 6);
  EXPECT_NE(error_of([&] { load(draco_scene(bomb)); }).find("says it has 2147483648 points"), std::string::npos);
}

}  // namespace
}  // namespace chiaro::renderer::tests
