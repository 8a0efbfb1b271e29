#include "renderer/scene/scene.h"

#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"

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

Scene one_triangle() {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {3, Vec3f{0, 0, 1}};
  mesh.tangents = {3, Vec4f{1, 0, 0, 1}};
  for (auto& uv : mesh.uv) uv = {3, Vec2f{0.25F, 0.5F}};
  mesh.colors = {3, Vec4f{1, 1, 1, 1}};
  mesh.triangles = {{0, 1, 2}};
  scene.instances.emplace_back();
  scene.materials.resize(2);
  scene.materials[0].layers.emplace();
  return scene;
}

// Most instances lie within what the ones before take up.
TEST(SceneBounds, AreAroundTheVerticesOfTheTrianglesOfAllInstances) {
  Scene scene = one_triangle();
  scene.meshes[0].positions.push_back({100, 100, 100});  // of no triangle
  scene.instances.clear();
  Sampler sampler(1, 0, 0);
  Box3f expected;
  for (int i = 0; i < 500; ++i) {
    Mat4f transform;
    for (float& entry : transform.m) entry = 2 * sampler.next_1d() - 1;
    scene.instances.push_back({"", 0, transform, -1});
    for (int v = 0; v < 3; ++v) expected.extend(transform_point(transform, scene.meshes[0].positions[std::size_t(v)]));
  }
  EXPECT_EQ(bounds(scene), expected);
}

// A cache of a scene that has changed in any of these would give wrong light without a word.
TEST(SceneFingerprint, TellsAllThatLightTransportDependsOn) {
  const Scene scene = one_triangle();
  const std::string before = fingerprint(scene);
  std::vector<std::function<void(Scene&)>> changes{
      [](Scene& s) { s.meshes[0].positions[1].x = 2; },
      [](Scene& s) { s.meshes[0].normals[1].x = 2; },
      [](Scene& s) { s.meshes[0].tangents[1].w = -1; },
      [](Scene& s) { s.meshes[0].colors[1].x = 0.5F; },
      [](Scene& s) {
        s.meshes[0].triangles[0] = {0, 2, 1};
      },
      [](Scene& s) { s.meshes[0].material = 1; },
      [](Scene& s) { s.instances[0].world_from_object(0, 3) = 1; },
      [](Scene& s) { s.instances.emplace_back(); },
  };
  for (std::size_t n = 0; n < kUvSetCount; ++n) {
    changes.emplace_back([n](Scene& s) { s.meshes[0].uv[n][1].x = 1; });
  }
  const auto of_material = [&](auto change) { changes.emplace_back([change](Scene& s) { change(s.materials[0]); }); };
  of_material([](Material& m) { m.base_color.y = 0.5F; });
  of_material([](Material& m) { m.alpha = 0.5F; });
  of_material([](Material& m) { m.metallic = 0.5F; });
  of_material([](Material& m) { m.roughness = 0.5F; });
  of_material([](Material& m) { m.normal_scale = 0.5F; });
  of_material([](Material& m) { m.emission.z = 1; });
  of_material([](Material& m) { m.alpha_mode = AlphaMode::kBlend; });
  of_material([](Material& m) { m.alpha_cutoff = 0.25F; });
  of_material([](Material& m) { m.lambert = true; });
  of_material([](Material& m) { m.constant_base_color = true; });
  of_material([](Material& m) { m.unlit = true; });
  of_material([](Material& m) { m.layers.reset(); });
  const auto of_layers = [&](auto change) { of_material([change](Material& m) { change(*m.layers); }); };
  for (const auto member : {&MaterialLayers::ior, &MaterialLayers::specular, &MaterialLayers::transmission,
                            &MaterialLayers::clearcoat, &MaterialLayers::clearcoat_roughness,
                            &MaterialLayers::clearcoat_normal_scale, &MaterialLayers::sheen_roughness}) {
    of_layers([member](MaterialLayers& l) { l.*member += 0.25F; });
  }
  for (const auto member :
       {&MaterialLayers::specular_color, &MaterialLayers::absorption, &MaterialLayers::sheen_color}) {
    of_layers([member](MaterialLayers& l) { (l.*member).y += 0.25F; });
  }
  of_layers([](MaterialLayers& l) { l.solid = true; });
  const auto of_use = [&](auto use) {
    changes.emplace_back([use](Scene& s) { use(s).texture = 0; });
    changes.emplace_back([use](Scene& s) { use(s).uv_set = 1; });
    changes.emplace_back([use](Scene& s) { use(s).transformed = true; });
  };
  for (const auto member : {&Material::base_color_texture, &Material::metallic_roughness_texture,
                            &Material::normal_texture, &Material::emission_texture}) {
    of_use([member](Scene& s) -> TextureUse& { return s.materials[0].*member; });
  }
  for (const auto member : {&MaterialLayers::specular_texture, &MaterialLayers::specular_color_texture,
                            &MaterialLayers::transmission_texture, &MaterialLayers::clearcoat_texture,
                            &MaterialLayers::clearcoat_roughness_texture, &MaterialLayers::clearcoat_normal_texture,
                            &MaterialLayers::sheen_color_texture, &MaterialLayers::sheen_roughness_texture}) {
    of_use([member](Scene& s) -> TextureUse& { return (*s.materials[0].layers).*member; });
  }
  for (std::size_t k = 0; k < changes.size(); ++k) {
    Scene other = scene;
    changes[k](other);
    EXPECT_NE(fingerprint(other), before) << k;
  }
  Scene same = scene;
  same.path = "elsewhere.glb";
  same.cameras.emplace_back();
  EXPECT_EQ(fingerprint(same), before);
}

}  // namespace
}  // namespace chiaro::renderer
