// What `render` warns of.

#include <gtest/gtest.h>

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

// Triangles with these materials, without a light.
std::string warnings_of(const ordered_json& materials) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  gltf.root["materials"] = materials;
  gltf.primitive()["material"] = 0;
  for (int m = 1; m < int(materials.size()); ++m) {
    const int mesh = gltf.add_mesh(gltf.primitive()["attributes"]);
    gltf.primitive(mesh)["material"] = m;
    gltf.add_node({{"mesh", mesh}});
  }
  const auto scene = folder.write("scene.glb", gltf.glb());
  const Outcome outcome = run_with(
      {"render", scene.string(), "-o", (folder.path() / "frame.exr").string(), "--width", "4", "--samples", "1"});
  EXPECT_EQ(outcome.exit_code, kDone) << outcome.standard_error;
  return outcome.standard_error;
}

bool mentions(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST(CliRender, SaysWhatIsBlackWithoutLight) {
  const ordered_json lit = ordered_json::object();
  const ordered_json unlit = {{"extensions", {{"KHR_materials_unlit", ordered_json::object()}}}};
  const ordered_json lamp = {{"emissiveFactor", {1, 1, 1}}};
  const std::string dark = warnings_of(ordered_json::array({lit}));
  EXPECT_TRUE(mentions(dark, "no light: the frame is black")) << dark;
  const std::string mixed = warnings_of(ordered_json::array({lit, unlit}));
  EXPECT_TRUE(mentions(mixed, "no light: all but unlit surfaces is black")) << mixed;
  for (const ordered_json& materials : {ordered_json::array({unlit}), ordered_json::array({lit, lamp})}) {
    EXPECT_FALSE(mentions(warnings_of(materials), "no light")) << materials;
  }
}

}  // namespace
}  // namespace chiaro::cli
