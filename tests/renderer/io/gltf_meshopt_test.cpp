#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "renderer/io/load_gltf.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

constexpr std::size_t kVertices = 600;

// A strip of triangles that winds along x.
std::vector<float> positions() {
  std::vector<float> values;
  for (std::size_t i = 0; i < kVertices; ++i) {
    values.insert(values.end(), {float(i / 2), float(i % 2), 0.01F * float(i % 17)});
  }
  return values;
}

std::vector<std::uint32_t> indices() {
  std::vector<std::uint32_t> values;
  for (std::uint32_t i = 0; i + 2 < kVertices; ++i) values.insert(values.end(), {i, i + 1 + i % 2, i + 2 - i % 2});
  return values;
}

using Bytes = std::vector<unsigned char>;

std::string text_of(const Bytes& bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes.data()), size};
}

std::string encoded_vertices(const void* values, std::size_t count, std::size_t stride) {
  Bytes bytes(meshopt_encodeVertexBufferBound(count, stride));
  return text_of(bytes, meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values, count, stride));
}

std::string encoded_triangles(const std::vector<std::uint32_t>& values) {
  Bytes bytes(meshopt_encodeIndexBufferBound(values.size(), kVertices));
  return text_of(bytes, meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), values.data(), values.size()));
}

std::string encoded_sequence(const std::vector<std::uint32_t>& values) {
  Bytes bytes(meshopt_encodeIndexSequenceBound(values.size(), kVertices));
  return text_of(bytes, meshopt_encodeIndexSequence(bytes.data(), bytes.size(), values.data(), values.size()));
}

struct Packed {
  std::string bytes;
  std::size_t count = 0, stride = 0;
  const char* mode = "ATTRIBUTES";
  const char* filter = "NONE";
};

// A compressed view in a buffer of its own range; its plain form is in buffer 1, which has no data.
int add_packed(GltfBuilder& gltf, const Packed& packed) {
  const int raw = gltf.add_view(packed.bytes);
  ordered_json& view = gltf.root["bufferViews"][std::size_t(raw)];
  ordered_json extension = {{"buffer", 0},
                            {"byteOffset", view["byteOffset"]},
                            {"byteLength", packed.bytes.size()},
                            {"byteStride", packed.stride},
                            {"count", packed.count},
                            {"mode", packed.mode}};
  if (std::string(packed.filter) != "NONE") extension["filter"] = packed.filter;
  view = {{"buffer", 1}, {"byteLength", packed.count * packed.stride}};
  if (std::string(packed.mode) == "ATTRIBUTES") view["byteStride"] = packed.stride;
  view["extensions"]["EXT_meshopt_compression"] = extension;
  return raw;
}

int add_accessor(GltfBuilder& gltf, int view, const ordered_json& rest) {
  ordered_json accessor = {{"bufferView", view}};
  accessor.update(rest);
  return gltf.add_accessor(accessor);
}

void finish(GltfBuilder& gltf) {
  gltf.root["buffers"] = {{{"byteLength", gltf.binary.size()}}, {{"byteLength", 1U << 20}}};
  gltf.root["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
  gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"EXT_meshopt_compression"};
}

GltfBuilder packed_scene(bool sequence) {
  GltfBuilder gltf;
  const std::vector<float> p = positions();
  const std::vector<std::uint32_t> i = indices();
  const int vertices = add_packed(gltf, {encoded_vertices(p.data(), kVertices, 12), kVertices, 12});
  const int triangles = add_packed(gltf, sequence ? Packed{encoded_sequence(i), i.size(), 4, "INDICES"}
                                                  : Packed{encoded_triangles(i), i.size(), 4, "TRIANGLES"});
  gltf.add_mesh({{"POSITION",
                  add_accessor(gltf, vertices, {{"componentType", kFloat}, {"count", kVertices}, {"type", "VEC3"}})}});
  gltf.primitive()["indices"] =
      add_accessor(gltf, triangles, {{"componentType", kUnsignedInt}, {"count", i.size()}, {"type", "SCALAR"}});
  gltf.add_node({{"mesh", 0}});
  return gltf;
}

LoadedScene load(GltfBuilder gltf) {
  finish(gltf);
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.glb", gltf.glb()));
}

// Corners in the order of the file, whatever the indices are after loading.
std::vector<Vec3f> corners(const Mesh& mesh) {
  std::vector<Vec3f> points;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) points.push_back(mesh.positions[v]);
  }
  return points;
}

TEST(Meshopt, SequencesOfIndicesComeBackExactly) {
  const LoadedScene loaded = load(packed_scene(true));
  const std::vector<float> p = positions();
  std::vector<Vec3f> expected;
  for (const std::uint32_t i : indices()) expected.push_back({p[3 * i], p[3 * i + 1], p[3 * i + 2]});
  EXPECT_EQ(corners(loaded.scene.meshes.at(0)), expected);
}

TEST(Meshopt, TrianglesComeBackWithTheirWinding) {
  const LoadedScene plain = load(packed_scene(true)), packed = load(packed_scene(false));
  const std::vector<Vec3f> a = corners(plain.scene.meshes.at(0)), b = corners(packed.scene.meshes.at(0));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t t = 0; t < a.size(); t += 3) {
    const Vec3f normal = cross(a[t + 1] - a[t], a[t + 2] - a[t]);  // corners may have been rotated
    EXPECT_EQ(cross(b[t + 1] - b[t], b[t + 2] - b[t]).z > 0, normal.z > 0);
    EXPECT_LT(length(a[t] + a[t + 1] + a[t + 2] - b[t] - b[t + 1] - b[t + 2]), 1e-3F);
  }
}

Vec3f direction(std::size_t i) {
  const float phi = 0.7F * float(i), z = 1 - 2 * (float(i) + 0.5F) / float(kVertices), r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

TEST(Meshopt, OctahedralNormalsAndExponentialPositions) {
  GltfBuilder gltf = packed_scene(true);
  std::vector<float> directions;
  for (std::size_t i = 0; i < kVertices; ++i) {
    const Vec3f n = direction(i);
    directions.insert(directions.end(), {n.x, n.y, n.z, 0});
  }
  std::vector<std::int16_t> octahedral(4 * kVertices);
  meshopt_encodeFilterOct(octahedral.data(), kVertices, 8, 16, directions.data());
  const int normals =
      add_packed(gltf, {encoded_vertices(octahedral.data(), kVertices, 8), kVertices, 8, "ATTRIBUTES", "OCTAHEDRAL"});
  gltf.primitive()["attributes"]["NORMAL"] = add_accessor(
      gltf, normals, {{"componentType", kShort}, {"normalized", true}, {"count", kVertices}, {"type", "VEC3"}});
  const std::vector<float> p = positions();
  std::vector<std::uint32_t> exponential(3 * kVertices);
  meshopt_encodeFilterExp(exponential.data(), kVertices, 12, 23, p.data());
  const int vertices = add_packed(
      gltf, {encoded_vertices(exponential.data(), kVertices, 12), kVertices, 12, "ATTRIBUTES", "EXPONENTIAL"});
  gltf.primitive()["attributes"]["POSITION"] =
      add_accessor(gltf, vertices, {{"componentType", kFloat}, {"count", kVertices}, {"type", "VEC3"}});
  const LoadedScene loaded = load(gltf);
  const Mesh& mesh = loaded.scene.meshes.at(0);
  ASSERT_EQ(mesh.normals.size(), kVertices);
  for (std::size_t i = 0; i < kVertices; ++i) {
    EXPECT_LT(length(mesh.normals[i] - direction(i)), 2e-4F) << i;
    EXPECT_LT(length(mesh.positions[i] - Vec3f{p[3 * i], p[3 * i + 1], p[3 * i + 2]}), 1e-4F) << i;
  }
}

TEST(Meshopt, QuaternionsOfInstances) {
  GltfBuilder gltf = packed_scene(true);
  constexpr std::size_t kCopies = 4;
  const float h = std::sqrt(0.5F);
  const std::vector<float> rotations{0, 0, 0, 1, 0, h, 0, h, h, 0, 0, h, 0, 0, 1, 0};
  std::vector<std::int16_t> packed(4 * kCopies);
  meshopt_encodeFilterQuat(packed.data(), kCopies, 8, 16, rotations.data());
  const int view =
      add_packed(gltf, {encoded_vertices(packed.data(), kCopies, 8), kCopies, 8, "ATTRIBUTES", "QUATERNION"});
  const int accessor =
      add_accessor(gltf, view, {{"componentType", kShort}, {"normalized", true}, {"count", kCopies}, {"type", "VEC4"}});
  gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = accessor;
  const LoadedScene loaded = load(gltf);
  ASSERT_EQ(loaded.scene.instances.size(), kCopies);
  const auto turned = [&](std::size_t i, Vec3f d) {
    return transform_direction(loaded.scene.instances[i].world_from_object, d);
  };
  EXPECT_LT(length(turned(1, {1, 0, 0}) - Vec3f{0, 0, -1}), 1e-3F);
  EXPECT_LT(length(turned(2, {0, 1, 0}) - Vec3f{0, 0, 1}), 1e-3F);
  EXPECT_LT(length(turned(3, {1, 0, 0}) - Vec3f{-1, 0, 0}), 1e-3F);
}

TEST(Meshopt, AViewThatContradictsItsCompressionIsRefused) {
  for (const auto& [name, value] : {std::pair("byteStride", 16), {"byteLength", 96}}) {
    GltfBuilder gltf = packed_scene(true);
    finish(gltf);
    for (auto& view : gltf.root["bufferViews"]) {
      if (view.contains("extensions")) view[name] = value;
    }
    const TemporaryFolder folder;
    const std::string message = error_of([&] { load_gltf(folder.write("scene.glb", gltf.glb())); });
    EXPECT_NE(message.find(std::string("].") + name + ": is"), std::string::npos) << message;
    EXPECT_NE(message.find("as EXT_meshopt_compression has it"), std::string::npos) << message;
  }
}

TEST(Meshopt, DamagedDataAreRefusedOrReadButNeverCrash) {
  GltfBuilder gltf = packed_scene(false);
  std::size_t refused = 0, tried = 0;
  const std::string whole = gltf.binary;
  for (std::size_t at = 0; at < whole.size(); at += 11, ++tried) {
    gltf.binary = whole;
    gltf.binary[at] = char(gltf.binary[at] ^ 0x5A);
    const std::string message = error_of([&] { load(gltf); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    refused += message.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 0U);
}

struct SpoiltView {
  const char* key;
  ordered_json value;
  const char* expected;
};

TEST(Meshopt, WhatCannotBeIsRefusedByPlace) {
  const SpoiltView cases[] = {{"mode", "NONSENSE", ".mode: is \"NONSENSE\""},
                              {"filter", "NONSENSE", ".filter"},
                              {"filter", "QUATERNION", ".filter"},
                              {"byteStride", 3, ".byteStride: is 3"},
                              {"byteStride", 0, ".byteStride: is 0"},
                              {"byteStride", 1024, ".byteStride: is 1024"},
                              {"count", 4000000000U, "4000000000 elements in"},
                              {"byteLength", 7, "is damaged"},
                              {"byteLength", 4000000000U, "reach beyond buffers[0]"},
                              {"buffer", 9, "9 is out of range"},
                              {"buffer", 1, "reach beyond buffers[1]"}};
  for (const SpoiltView& spoilt : cases) {
    GltfBuilder gltf = packed_scene(false);
    gltf.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][spoilt.key] = spoilt.value;
    if (std::string(spoilt.key) == "byteLength" && spoilt.value == 7) {
      gltf.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 2;
    }
    const std::string message = error_of([&] { load(gltf); });
    EXPECT_NE(message.find("bufferViews[0].extensions.EXT_meshopt_compression"), std::string::npos) << message;
    EXPECT_NE(message.find(spoilt.expected), std::string::npos) << message;
  }
}

// Each view is small enough for its bytes, which all of them have.
TEST(Meshopt, ViewsOfTheSameBytesAreRefusedBeforeTheyTakeMemory) {
  GltfBuilder gltf = packed_scene(false);
  ordered_json view = gltf.root["bufferViews"][0];
  ordered_json& packed = view["extensions"]["EXT_meshopt_compression"];
  const std::size_t length = packed["byteLength"], stride = packed["byteStride"];
  packed["count"] = 60 * (length / stride);
  view["byteLength"] = 60 * (length / stride) * stride;
  for (int i = 0; i < 30000; ++i) gltf.root["bufferViews"].push_back(view);
  const std::string message = error_of([&] { load(gltf); });
  EXPECT_NE(message.find("come of buffers of"), std::string::npos) << message.substr(0, 300);
}

}  // namespace
}  // namespace chiaro::renderer::tests
