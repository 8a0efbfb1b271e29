// --hide-backs, of commands that make pictures and of those that read them.

#include <algorithm>

#include <gtest/gtest.h>

#include "renderer/image/image_file.h"
#include "tests/cli/run_with.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::cli {
namespace {

using renderer::tests::GltfBuilder;
using renderer::tests::ordered_json;
using renderer::tests::triangle_scene;
using test::TemporaryFolder;
using tests::Outcome;
using tests::run_with;

// A camera before the front of a white triangle; between them a black one, which turns its back on the camera.
std::string two_triangles() {
  GltfBuilder gltf = triangle_scene();
  gltf.root["materials"] = ordered_json::array({{{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}});
  gltf.root["materials"].push_back(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0, 0, 0, 1}}}}});
  gltf.primitive()["material"] = 0;
  const int near = gltf.add_mesh(gltf.primitive()["attributes"]);
  gltf.primitive(near)["material"] = 1;
  gltf.add_node({{"mesh", near}, {"translation", {0.75, 0, 1}}, {"rotation", {0, 1, 0, 0}}});
  gltf.root["cameras"] = ordered_json::array();
  gltf.root["cameras"].push_back({{"type", "perspective"}, {"perspective", {{"yfov", 0.2}, {"znear", 0.1}}}});
  gltf.add_node({{"camera", 0}, {"translation", {0.25, 0.25, 2}}});
  return gltf.glb();
}

class CliHiddenBacks : public testing::Test {
 protected:
  // The white triangle painted, pictured by the camera.
  std::string picture(const std::string& name, const std::vector<std::string>& more) const {
    const std::string strokes =
        folder_.write("s.json", R"({"strokes":[{"color":[1,1,1],"radius":9,"path":[[0.25,0.25,0]]}]})").string();
    const std::string file = folder_ / name;
    std::vector<std::string> arguments{"paint",   scene_, "--strokes", strokes, "--picture", file,
                                       "--width", "8",    "--height",  "8",     "-o",        folder_ / "painted.glb"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_with(arguments);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
    return file;
  }

  bool no_pixel_tells(const std::string& picture, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"solve",
                                       scene_,
                                       "--target-image",
                                       picture,
                                       "--lights",
                                       "1",
                                       "--grid",
                                       "2,2,2",
                                       "--samples",
                                       "4",
                                       "--bounces",
                                       "0",
                                       "-o",
                                       folder_ / "lights.glb"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_with(arguments).standard_error.find("no pixel tells an illumination") != std::string::npos;
  }

  TemporaryFolder folder_;
  const std::string scene_ = folder_.write("scene.glb", two_triangles()).string();
};

float brightest(const std::string& file) {
  const renderer::Image image = renderer::load_image(file).image;
  const int red = image.find_channel("R");
  float most = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) most = std::max(most, image.at(x, y)[red]);
  }
  return most;
}

TEST_F(CliHiddenBacks, PicturesShowWhatIsBehind) {
  EXPECT_EQ(brightest(picture("all.exr", {})), 0);
  EXPECT_GT(brightest(picture("hidden.exr", {"--hide-backs"})), 0.5F);
}

TEST_F(CliHiddenBacks, SolvesReadPicturesOfWhatIsBehind) {
  const std::string frame = picture("hidden.exr", {"--hide-backs"});
  EXPECT_TRUE(no_pixel_tells(frame, {}));
  EXPECT_FALSE(no_pixel_tells(frame, {"--hide-backs"}));
}

}  // namespace
}  // namespace chiaro::cli
