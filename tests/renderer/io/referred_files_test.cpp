#include "renderer/io/referred_files.h"

#include <gtest/gtest.h>

#include "renderer/io/gltf_container.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::renderer {
namespace {

namespace fs = std::filesystem;

class ReferredFiles : public testing::Test {
 protected:
  // Names that are in the folder, with each other spelling that a URI may stand for left out.
  std::vector<std::string> of(const std::string& name) const {
    std::vector<std::string> names;
    for (const fs::path& file : referred_files(folder_ / name)) {
      if (names.empty() || names.back() != file.filename()) names.push_back(file.filename().string());
    }
    return names;
  }
  using Names = std::vector<std::string>;
  test::TemporaryFolder folder_;
};

const std::string kScene = R"({"buffers": [{"uri": "data:,x"}, {"uri": "a.bin"}], "uri": {"image": 1},
  "extras": {"name": "image", "file": "no.bin"}, "images": [{"uri": "b.png"}, {"bufferView": 0}]})";

TEST_F(ReferredFiles, AreBuffersAndImagesOfScenes) {
  folder_.write("scene.gltf", "\xEF\xBB\xBF \n" + kScene);
  EXPECT_EQ(of("scene.gltf"), (Names{"a.bin", "b.png"}));
  folder_.write("scene.glb", make_glb({kScene, R"({"uri": "c.bin"})", {}}, "scene.glb"));
  EXPECT_EQ(of("scene.glb"), (Names{"a.bin", "b.png"}));
}

TEST_F(ReferredFiles, AreImagesOfLightFiles) {
  folder_.write("lights.json", R"({"lights": [{"type": "environment", "image": "sky.exr"}]})");
  EXPECT_EQ(of("lights.json"), Names{"sky.exr"});
}

TEST_F(ReferredFiles, MayBeEncoded) {
  folder_.write("scene.gltf", R"({"buffers": [{"uri": "a%20b.bin"}]})");
  EXPECT_EQ(of("scene.gltf"), (Names{"a b.bin", "a%20b.bin"}));
}

TEST_F(ReferredFiles, AreNotLookedForElsewhere) {
  folder_.write("frame.exr", R"(v/1 {"uri": "a.bin"})");
  folder_.write("short.glb", make_glb({kScene, {}, {}}, "").substr(0, 14));
  for (const char* name : {"frame.exr", "short.glb", "missing.gltf", "."}) EXPECT_EQ(of(name), Names{}) << name;
  folder_.write("deep.json", std::string(1'000'000, '['));
  folder_.write("cut.gltf", kScene.substr(0, 70));
  EXPECT_EQ(of("deep.json"), Names{});
  EXPECT_EQ(of("cut.gltf"), Names{"a.bin"});
}

}  // namespace
}  // namespace chiaro::renderer
