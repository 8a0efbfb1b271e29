#include "renderer/core/external_files.h"

#include <gtest/gtest.h>

#include "renderer/io/load_gltf.h"
#include "renderer/io/save_gltf.h"
#include "renderer/io/vertex_mesh_file.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

// A triangle whose buffer is outside.
std::filesystem::path scene_with_buffer(const TemporaryFolder& folder, const std::string& uri) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["buffers"] = ordered_json::array({{{"byteLength", gltf.binary.size()}, {"uri", uri}}});
  return folder.write("scene.gltf", gltf.root.dump());
}

std::string refusal(const std::filesystem::path& scene) {
  return error_of([&] { load_gltf(scene); });
}

TEST(ExternalFiles, AreInTheFolderOrBelow) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a/b");
  folder.write("a/b/in.bin", "x");
  folder.write("outside.bin", "x");
  EXPECT_TRUE(is_in_folder(folder / "a/b/in.bin", folder / "a"));
  EXPECT_TRUE(is_in_folder(folder / "a/b/../b/in.bin", folder / "a/b/"));
  EXPECT_FALSE(is_in_folder(folder / "outside.bin", folder / "a"));
  EXPECT_FALSE(is_in_folder(folder / "a/../outside.bin", folder / "a"));
  EXPECT_FALSE(is_in_folder(folder / "a/missing.bin", folder / "a"));
}

TEST(ExternalFiles, AFolderWhoseNameBeginsAlikeIsAnother) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a");
  std::filesystem::create_directories(folder / "ab");
  folder.write("ab/file", "x");
  EXPECT_FALSE(is_in_folder(folder / "ab/file", folder / "a"));
}

TEST(ExternalFiles, ScenesOpenThoseOfTheirFolderOnly) {
  const TemporaryFolder folder, elsewhere;
  const auto outside = elsewhere.write("outside.bin", triangle_scene().binary);
  const std::string above = "../" + outside.parent_path().filename().string() + "/outside.bin";
  for (const std::string& uri : {outside.string(), above}) {
    const auto scene = scene_with_buffer(folder, uri);
    EXPECT_NE(refusal(scene).find("buffers[0].uri: \""), std::string::npos) << refusal(scene);
    EXPECT_NE(error_of([&] { load_vertex_mesh(scene); }), "");
    EXPECT_NE(error_of([&] { save_gltf_with_lights(scene, {}, folder / "out.glb", {}); }), "");
    EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
  }
  const auto scene = scene_with_buffer(folder, above);
  EXPECT_NE(refusal(scene).find("is outside its folder"), std::string::npos) << refusal(scene);
  EXPECT_EQ(load_gltf(scene, {.external = ExternalFiles::kAnywhere}).scene.meshes.size(), 1U);
  save_gltf_with_lights(scene, {}, folder / "out.glb", {.external = ExternalFiles::kAnywhere});
  EXPECT_EQ(load_gltf(folder / "out.glb").scene.meshes.size(), 1U);
}

TEST(ExternalFiles, LinksAreFollowed) {
  const TemporaryFolder folder, elsewhere;
  std::filesystem::create_symlink(elsewhere.write("outside.bin", triangle_scene().binary), folder / "link.bin");
  const auto scene = scene_with_buffer(folder, "link.bin");
  EXPECT_NE(refusal(scene).find("is outside its folder"), std::string::npos) << refusal(scene);
  std::filesystem::remove(folder / "link.bin");
  std::filesystem::create_symlink(folder.write("inside.bin", triangle_scene().binary), folder / "link.bin");
  EXPECT_EQ(refusal(scene), "");
}

}  // namespace
}  // namespace chiaro::renderer::tests
