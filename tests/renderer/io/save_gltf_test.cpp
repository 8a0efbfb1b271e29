#include "renderer/io/save_gltf.h"

#include <gtest/gtest.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/vec.h"
#include "renderer/image/image_file.h"
#include "renderer/io/load_gltf.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

using renderer::Lights;
using renderer::load_gltf;
using renderer::LoadedScene;
using renderer::save_gltf_with_lights;
using renderer::Vec3f;

// Not among the scene's keys that adding lights may touch.
constexpr const char* kKept[] = {"asset", "materials", "meshes", "accessors", "bufferViews", "extras"};

Lights some_lights() {
  return {renderer::PointLight{"key", {1, 2.3F, -4}, {0.3F, 40, 5}},
          renderer::SpotLight{"rim", {0, 1, 0}, normalize(Vec3f{1, -2, 3}), {7, 8, 9}, 0.2F, 0.4F},
          renderer::DirectionalLight{"sun", {0, 0, 1}, {1000, 900, 800}},
          renderer::DirectionalLight{"moon", {0, 0, -1}, {0, 0, 0}}};
}

GltfBuilder rich_scene() {
  GltfBuilder gltf = triangle_scene();
  gltf.root["extras"] = {{"number", 0.1}, {"big", 12345678901234567LL}, {"text", "ü"}};
  gltf.root["materials"] = ordered_json::array({{{"extensions", {{"VENDOR_thing", {{"deep", {1, 2.5, "x"}}}}}}}});
  gltf.root["extensionsUsed"] = {"VENDOR_thing"};
  gltf.primitive()["material"] = 0;
  gltf.root["scenes"] = ordered_json::array({{{"nodes", {0}}, {"name", "main"}}});
  gltf.root["scene"] = 0;
  return gltf;
}

ordered_json json_of(const std::filesystem::path& path) {
  return ordered_json::parse(renderer::read_gltf_container(path).json);
}

void expect_near(Vec3f a, Vec3f b, float relative = 2e-6F) { EXPECT_LE(length(a - b), relative * (1 + length(b))); }

void expect_same(const Lights& found, const Lights& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(name_of(found[i]), name_of(expected[i]));
    ASSERT_EQ(found[i].index(), expected[i].index());
  }
  const auto& key = std::get<renderer::PointLight>(found[0]);
  EXPECT_EQ(key.position, (Vec3f{1, 2.3F, -4}));
  expect_near(key.intensity, {0.3F, 40, 5});
  const auto& rim = std::get<renderer::SpotLight>(found[1]);
  expect_near(rim.direction, normalize(Vec3f{1, -2, 3}));
  EXPECT_EQ(rim.inner_cone_angle, 0.2F);
  EXPECT_EQ(rim.outer_cone_angle, 0.4F);
  expect_near(rim.intensity, {7, 8, 9});
  expect_near(std::get<renderer::DirectionalLight>(found[2]).direction, {0, 0, 1});
  expect_near(std::get<renderer::DirectionalLight>(found[2]).illuminance, {1000, 900, 800});
  expect_near(std::get<renderer::DirectionalLight>(found[3]).direction, {0, 0, -1});
  EXPECT_EQ(std::get<renderer::DirectionalLight>(found[3]).illuminance, (Vec3f{0, 0, 0}));
}

class SaveGltf : public testing::TestWithParam<const char*> {};

TEST_P(SaveGltf, LightsComeBackAndNothingElseChanges) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.glb", rich_scene().glb()), lit = folder / GetParam();
  save_gltf_with_lights(scene, some_lights(), lit, {});
  expect_same(load_gltf(lit).lights, some_lights());
  const ordered_json before = json_of(scene), after = json_of(lit);
  for (const char* key : kKept) EXPECT_EQ(before[key].dump(), after[key].dump()) << key;
  EXPECT_EQ(after["nodes"][0], before["nodes"][0]);
  EXPECT_EQ(after["extensionsUsed"].dump(), R"(["VENDOR_thing","KHR_lights_punctual"])");
  EXPECT_EQ(after["scenes"][0]["nodes"].size(), 5U);
  EXPECT_EQ(fingerprint(load_gltf(lit).scene), fingerprint(load_gltf(scene).scene));
}

INSTANTIATE_TEST_SUITE_P(Containers, SaveGltf, testing::Values("lit.glb", "lit.gltf"), test::kByText);

// Two lamps of one definition, one below a node that moves, and a third in no scene.
TEST(SaveGltfLights, OfNodesStayThereWithNewIntensities) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.root["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 5}, {"color", {1, 0.5, 0}}, {"range", 9}, {"name", "bulb"}}};
  const ordered_json bulb = {{"KHR_lights_punctual", {{"light", 0}}}};
  const int arm = gltf.add_node({{"name", "arm"}, {"translation", {0, 2, 0}}});
  const int left = gltf.add_node({{"name", "left"}, {"translation", {1, 0, 0}}, {"extensions", bulb}});
  const int right = gltf.add_node({{"name", "right"}, {"translation", {-1, 0, 0}}, {"extensions", bulb}});
  gltf.add_node({{"name", "spare"}, {"extensions", bulb}});
  gltf.root["nodes"][std::size_t(arm)]["children"] = {left};
  gltf.root["scenes"] = ordered_json::array({{{"nodes", {0, arm, right}}}});
  gltf.root["scene"] = 0;
  const auto scene = folder.write("scene.glb", gltf.glb()), lit = folder / "lit.glb";
  const renderer::LoadedScene before = load_gltf(scene);
  ASSERT_EQ(before.light_nodes, (std::vector<int>{left, right}));
  Lights wanted = before.lights;
  std::get<renderer::PointLight>(wanted[0]).intensity = {1, 2, 3};
  std::get<renderer::PointLight>(wanted[1]).intensity = {0, 0, 0};
  save_gltf_with_lights(scene, wanted, lit, {.relit_nodes = before.light_nodes});
  const Lights found = load_gltf(lit).lights;
  ASSERT_EQ(found.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& light = std::get<renderer::PointLight>(found[k]);
    EXPECT_EQ(light.name, k == 0 ? "left" : "right");
    expect_near(light.position, std::get<renderer::PointLight>(before.lights[k]).position);
    expect_near(light.intensity, std::get<renderer::PointLight>(wanted[k]).intensity);
  }
  const ordered_json old_root = json_of(scene), root = json_of(lit);
  EXPECT_EQ(root["nodes"].size(), old_root["nodes"].size()) << "none is added";
  EXPECT_EQ(root["nodes"][std::size_t(arm)], old_root["nodes"][std::size_t(arm)]);
  const ordered_json& definitions = root["extensions"]["KHR_lights_punctual"]["lights"];
  EXPECT_EQ(definitions[0], old_root["extensions"]["KHR_lights_punctual"]["lights"][0]) << "of the spare one";
  ASSERT_EQ(definitions.size(), 3U);
  for (std::size_t k = 1; k < definitions.size(); ++k) {
    EXPECT_EQ(definitions[k]["name"], "bulb");
    EXPECT_FALSE(definitions[k].contains("range")) << "the intensity found is without one";
  }
}

TEST(SaveGltfLights, OldOnesAreTakenOutUnlessKept) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.glb", rich_scene().glb()), lit = folder / "lit.glb";
  save_gltf_with_lights(scene, some_lights(), lit, {});
  save_gltf_with_lights(lit, {some_lights()[0]}, folder / "kept.glb", {.keep_lights = true});
  EXPECT_EQ(load_gltf(folder / "kept.glb").lights.size(), 5U);
  save_gltf_with_lights(lit, {some_lights()[0]}, folder / "one.glb", {});
  EXPECT_EQ(load_gltf(folder / "one.glb").lights.size(), 1U);
  save_gltf_with_lights(lit, {}, folder / "none.glb", {});
  EXPECT_TRUE(load_gltf(folder / "none.glb").lights.empty());
  EXPECT_EQ(renderer::read_gltf_container(folder / "none.glb").json.find("KHR_lights_punctual"), std::string::npos);
}

TEST(SaveGltfLights, ASceneMayBeSavedOverItself) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.glb", rich_scene().glb());
  save_gltf_with_lights(scene, some_lights(), scene, {});
  expect_same(load_gltf(scene).lights, some_lights());
}

TEST(SaveGltfLights, FilesWithoutScenesGetOneOfAllRoots) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.add_node({{"children", {0}}, {"translation", {0, 5, 0}}});
  const auto scene = folder.write("scene.glb", gltf.glb());
  save_gltf_with_lights(scene, some_lights(), folder / "lit.glb", {});
  const LoadedScene loaded = load_gltf(folder / "lit.glb");
  EXPECT_EQ(loaded.lights.size(), 4U);
  ASSERT_EQ(loaded.scene.instances.size(), 1U);
  EXPECT_EQ(loaded.scene.instances[0].world_from_object.column(3), (Vec3f{0, 5, 0}));
  EXPECT_EQ(json_of(folder / "lit.glb")["scenes"][0]["nodes"].front(), 1);
}

GltfBuilder scattered_scene(const TemporaryFolder& folder) {
  renderer::Image image = renderer::make_image(1, 1, {"R", "G", "B"});
  image.pixels = {1, 0, 0};
  save_image(image, folder / "red texel.png", renderer::PixelType::kUint8);
  GltfBuilder gltf = triangle_scene();
  folder.write("first.bin", gltf.binary);
  folder.write("second.bin", bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}));
  gltf.root["buffers"] =
      ordered_json::array({{{"byteLength", 36}, {"uri", "first.bin"}}, {{"byteLength", 36}, {"uri", "second.bin"}}});
  gltf.root["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 36}});
  const int normals = gltf.add_accessor({{"bufferView", 1}, {"componentType", kFloat}, {"count", 3}, {"type", "VEC3"}});
  gltf.primitive()["attributes"]["NORMAL"] = normals;
  gltf.root["images"] = ordered_json::array({{{"uri", "red%20texel.png"}}});
  gltf.root["textures"] = ordered_json::array({{{"source", 0}}});
  gltf.root["materials"] = ordered_json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  gltf.primitive()["material"] = 0;
  return gltf;
}

class SaveScatteredGltf : public testing::TestWithParam<const char*> {};

TEST_P(SaveScatteredGltf, ExternalBuffersAndImagesAreEmbedded) {
  const TemporaryFolder folder, elsewhere;
  const auto scene = folder.write("scene.gltf", scattered_scene(folder).root.dump());
  save_gltf_with_lights(scene, some_lights(), elsewhere / GetParam(), {});
  const LoadedScene loaded = load_gltf(elsewhere / GetParam());
  expect_same(loaded.lights, some_lights());
  EXPECT_EQ(fingerprint(loaded.scene), fingerprint(load_gltf(scene).scene));
  EXPECT_EQ(loaded.scene.textures.at(0).rgba, (std::vector<std::uint8_t>{255, 0, 0, 255}));
}

INSTANTIATE_TEST_SUITE_P(Containers, SaveScatteredGltf, testing::Values("lit.glb", "lit.gltf"), test::kByText);

TEST(SaveGltfLights, AMissingFileIsNamedAndNothingIsWritten) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.gltf", scattered_scene(folder).root.dump());
  std::filesystem::remove(folder / "second.bin");
  const std::string message = error_of([&] { save_gltf_with_lights(scene, {}, folder / "lit.glb", {}); });
  EXPECT_NE(message.find("second.bin"), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(folder / "lit.glb"));
}

// Nothing uses it, so that its scene loads.
TEST(SaveGltfLights, AnImageThatIsMissingStaysMissing) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.root["images"] = {{{"uri", "gone.png"}}};
  const auto scene = folder.write("scene.glb", gltf.glb());
  save_gltf_with_lights(scene, some_lights(), folder / "lit.glb", {});
  expect_same(load_gltf(folder / "lit.glb").lights, some_lights());
  EXPECT_NE(read_file(folder / "lit.glb").find("\"uri\":\"gone.png\""), std::string::npos);
}

// They would give the lights that were found what those before them did.
TEST(SaveGltfLights, AnimationsOfLightsThatAreGoneGoWithThem) {
  GltfBuilder gltf = triangle_scene();
  const auto channel = [](const char* pointer) {
    return ordered_json{
        {"sampler", 0},
        {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}};
  };
  const ordered_json samplers = {{{"input", 0}, {"output", 0}}}, of_node = channel("/nodes/0/translation"),
                     of_light = channel("/extensions/KHR_lights_punctual/lights/0/intensity");
  gltf.root["animations"] = {{{"samplers", samplers}, {"channels", {of_light}}},
                             {{"samplers", samplers}, {"channels", {of_light, of_node}}}};
  gltf.root["extensionsUsed"] = {"KHR_animation_pointer"};
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.glb", gltf.glb());
  const auto saved = [&] {
    save_gltf_with_lights(scene, some_lights(), folder / "lit.glb", {});
    return ordered_json::parse(read_gltf_container(folder / "lit.glb").json);
  };
  EXPECT_EQ(saved()["animations"], (ordered_json{{{"samplers", samplers}, {"channels", {of_node}}}}));
  gltf.root["animations"].erase(1);
  folder.write("scene.glb", gltf.glb());
  EXPECT_FALSE(saved().contains("animations"));
  EXPECT_EQ(saved()["extensionsUsed"], (ordered_json{"KHR_lights_punctual"}));
}

// All that this program reads, and what it does not, as compressing programs write it: a file is not read to be saved.
TEST(SaveGltfLights, CompressedDataAnimationsAndExtensionsStayAsTheyAre) {
  GltfBuilder gltf = triangle_scene();
  const int packed = gltf.add_view("not read, not changed");
  gltf.root["bufferViews"][std::size_t(packed)]["extensions"]["EXT_meshopt_compression"] = {
      {"buffer", 0}, {"byteLength", 21}, {"byteStride", 4}, {"count", 12}, {"mode", "ATTRIBUTES"}};
  gltf.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", packed},
                                                                  {"attributes", {{"POSITION", 0}}}};
  gltf.primitive()["targets"] = {{{"POSITION", 0}}};
  gltf.root["nodes"][0]["extensions"]["VENDOR_unknown"] = {{"deep", {1, 2.5, {{"x", nullptr}}}}};
  gltf.root["nodes"][0]["skin"] = 0;
  gltf.root["skins"] = {{{"joints", {0}}, {"extras", {{"rig", "a"}}}}};
  gltf.root["animations"] = {
      {{"samplers", {{{"input", 0}, {"output", 0}}}},
       {"channels",
        {{{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", 7}}}}}}}}}};
  gltf.root["extensionsUsed"] = {"VENDOR_unknown", "EXT_meshopt_compression", "KHR_draco_mesh_compression"};
  gltf.root["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_draco_mesh_compression"};
  gltf.root["buffers"] = {{{"byteLength", gltf.binary.size()}},
                          {{"byteLength", 48}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.glb", gltf.glb());
  save_gltf_with_lights(scene, {PointLight{"lamp", {1, 2, 3}, {4, 5, 6}}}, folder / "lit.glb", {});
  const GltfContainer before = read_gltf_container(scene), after = read_gltf_container(folder / "lit.glb");
  EXPECT_EQ(before.binary, after.binary);
  ordered_json expected = ordered_json::parse(before.json), saved = ordered_json::parse(after.json);
  EXPECT_EQ(saved["nodes"].size(), 2U);
  for (const char* changed : {"extensions", "scenes", "scene"}) saved.erase(changed);
  saved["nodes"].erase(1);
  saved["extensionsUsed"].erase(3);
  EXPECT_EQ(saved, expected);
}

TEST(SaveGltfLights, AFirstBufferWithoutDataMakesRoomForTheChunk) {
  GltfBuilder gltf = triangle_scene();
  const TemporaryFolder folder;
  folder.write("data.bin", gltf.binary);
  ordered_json root = gltf.root;
  root["buffers"] = {{{"byteLength", 36}}, {{"byteLength", 36}, {"uri", "data.bin"}}};
  root["bufferViews"][0]["buffer"] = 1;
  root["bufferViews"].push_back(
      {{"buffer", 0}, {"byteLength", 4}, {"extensions", {{"VENDOR_packing", {{"buffer", 1}, {"byteLength", 4}}}}}});
  const auto scene = folder.write("scene.gltf", root.dump());
  save_gltf_with_lights(scene, {}, folder / "lit.glb", {});
  const ordered_json saved = ordered_json::parse(read_gltf_container(folder / "lit.glb").json);
  EXPECT_EQ(saved["buffers"].size(), 3U);
  EXPECT_EQ(saved["bufferViews"][1]["buffer"], 1);
  EXPECT_EQ(saved["bufferViews"][1]["extensions"]["VENDOR_packing"]["buffer"], 2);
  EXPECT_EQ(fingerprint(load_gltf(folder / "lit.glb").scene), fingerprint(load_gltf(scene).scene));
}

TEST(SaveGltfLights, AnImageAloneGetsABufferOfItsOwn) {
  const TemporaryFolder folder;
  renderer::Image image = renderer::make_image(1, 1, {"R", "G", "B"});
  save_image(image, folder / "texel.png", renderer::PixelType::kUint8);
  const auto scene = folder.write("scene.gltf", R"({"asset":{"version":"2.0"},"images":[{"uri":"texel.png"}]})");
  save_gltf_with_lights(scene, some_lights(), folder / "lit.glb", {});
  const ordered_json json = json_of(folder / "lit.glb");
  EXPECT_EQ(json["images"][0].dump(), R"({"bufferView":0,"mimeType":"image/png"})");
  EXPECT_EQ(renderer::read_gltf_container(folder / "lit.glb").binary->substr(0, 4), "\x89PNG");
}

}  // namespace
}  // namespace chiaro::renderer::tests
