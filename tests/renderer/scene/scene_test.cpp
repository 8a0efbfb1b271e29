#include "renderer/scene/scene.h"

#include <gtest/gtest.h>

#include <functional>

namespace chiaro::renderer {
namespace {

// Whatever changes what a texture shows makes another scene of it, which no cache of the first one fits.
TEST(SceneFingerprint, TellsHowTexturesAreSampled) {
  Scene scene;
  scene.textures.push_back({.name = "", .width = 4, .height = 1, .rgba = std::vector<std::uint8_t>(16, 7)});
  const std::string before = fingerprint(scene);
  EXPECT_EQ(fingerprint(Scene(scene)), before);
  const std::function<void(Texture&)> changes[] = {[](Texture& t) { t.wrap_u = Wrap::kClampToEdge; },
                                                   [](Texture& t) { t.wrap_v = Wrap::kMirroredRepeat; },
                                                   [](Texture& t) { t.nearest = true; },
                                                   [](Texture& t) { t.filtered_as_stored = true; },
                                                   [](Texture& t) { t.width = 2, t.height = 2; },
                                                   [](Texture& t) { t.rgba[5] = 8; }};
  for (const auto& change : changes) {
    Scene other = scene;
    change(other.textures[0]);
    EXPECT_NE(fingerprint(other), before);
  }
}

}  // namespace
}  // namespace chiaro::renderer
