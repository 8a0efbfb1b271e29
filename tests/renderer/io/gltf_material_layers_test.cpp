#include <gtest/gtest.h>

#include "renderer/image/image_file.h"
#include "renderer/io/load_gltf.h"
#include "renderer/scene/material_override.h"
#include "tests/renderer/io/gltf_builder.h"
#include "tests/support/test_names.h"

namespace chiaro::renderer::tests {
namespace {

using J = ordered_json;

GltfBuilder scene_with(const J& material) {
  GltfBuilder gltf = triangle_scene();
  gltf.root["materials"] = J::array({material});
  gltf.primitive()["material"] = 0;
  return gltf;
}

// With two textures, of which the files have one texel each.
LoadedScene load(GltfBuilder gltf, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  Image image = make_image(1, 1, {"R", "G", "B"});
  save_image(image, folder / "a.png", PixelType::kUint8);
  save_image(image, folder / "b.png", PixelType::kUint8);
  gltf.root["images"] = J::array({{{"uri", "a.png"}}, {{"uri", "b.png"}}});
  gltf.root["textures"] = J::array({{{"source", 0}}, {{"source", 1}}});
  return load_gltf(folder.write("scene.glb", gltf.glb()), options);
}

Material material_of(const J& material) { return load(scene_with(material)).scene.materials.at(0); }

TEST(GltfMaterialLayers, ValuesComeThrough) {
  const Material m = material_of(
      {{"extensions",
        {{"KHR_materials_ior", {{"ior", 1.33}}},
         {"KHR_materials_specular",
          {{"specularFactor", 0.5}, {"specularColorFactor", {2, 1, 0.5}}, {"specularTexture", {{"index", 0}}}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", 1}}}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 0.1}, {"attenuationDistance", 2}, {"attenuationColor", {0.5, 1, 0}}}},
         {"KHR_materials_clearcoat",
          {{"clearcoatFactor", 1},
           {"clearcoatRoughnessFactor", 0.25},
           {"clearcoatNormalTexture", {{"index", 1}, {"scale", 0.5}}}}},
         {"KHR_materials_sheen",
          {{"sheenColorFactor", {0.1, 0.2, 0.3}},
           {"sheenRoughnessFactor", 0.4},
           {"sheenColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}}});
  ASSERT_TRUE(m.layers);
  const MaterialLayers& l = *m.layers;
  EXPECT_FLOAT_EQ(l.ior, 1.33F);
  EXPECT_FLOAT_EQ(l.specular, 0.5F);
  EXPECT_EQ(l.specular_color, (Vec3f{2, 1, 0.5F}));
  EXPECT_EQ(l.specular_texture.texture, 0);
  EXPECT_FLOAT_EQ(l.transmission, 0.75F);
  EXPECT_EQ(l.transmission_texture.texture, 1);
  EXPECT_TRUE(l.solid);
  EXPECT_FLOAT_EQ(l.absorption.x, std::log(2.0F) / 2);  // half is left after two metres
  EXPECT_EQ(l.absorption.y, 0);
  EXPECT_GT(l.absorption.z, 5);
  EXPECT_TRUE(is_finite(l.absorption));
  EXPECT_FLOAT_EQ(l.clearcoat, 1);
  EXPECT_FLOAT_EQ(l.clearcoat_roughness, 0.25F);
  EXPECT_EQ(l.clearcoat_normal_texture.texture, 1);
  EXPECT_FLOAT_EQ(l.clearcoat_normal_scale, 0.5F);
  EXPECT_EQ(l.sheen_color, (Vec3f{0.1F, 0.2F, 0.3F}));
  EXPECT_FLOAT_EQ(l.sheen_roughness, 0.4F);
  EXPECT_EQ(l.sheen_color_texture.uv_set, 1);
}

TEST(GltfMaterialLayers, AreAbsentWhereTheyChangeNothing) {
  EXPECT_FALSE(material_of({{"name", "plain"}}).layers);
  EXPECT_FALSE(material_of({{"extensions",
                             {{"KHR_materials_ior", {{"ior", 1.5}}},
                              {"KHR_materials_specular", J::object()},
                              {"KHR_materials_transmission", {{"transmissionFactor", 0}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                              {"KHR_materials_clearcoat", J::object()},
                              {"KHR_materials_sheen", J::object()}}}})
                   .layers);
}

TEST(GltfMaterialLayers, WithoutThicknessGlassIsThin) {
  const J transmission = {{"transmissionFactor", 1}};
  const auto solid = [&](const J& volume) {
    return material_of(
               {{"extensions", {{"KHR_materials_transmission", transmission}, {"KHR_materials_volume", volume}}}})
        .layers->solid;
  };
  EXPECT_FALSE(solid(J::object()));
  EXPECT_FALSE(solid({{"thicknessFactor", 0}}));
  EXPECT_TRUE(solid({{"thicknessFactor", 0.01}}));
}

// The largest float ended rendering: inside, the light's angle to it is that of 1 / ior, of which there is no inverse.
TEST(GltfMaterialLayers, EndlessIndicesAreThoseOfAMirror) {
  const LoadedScene loaded = load(scene_with({{"extensions", {{"KHR_materials_ior", {{"ior", 3.4028234e38}}}}}}));
  EXPECT_EQ(loaded.scene.materials[0].layers->ior, 1e6F);
}

TEST(GltfMaterialLayers, ValuesOutOfRangeAreClampedWithAWarning) {
  const LoadedScene loaded = load(scene_with(
      {{"extensions",
        {{"KHR_materials_ior", {{"ior", 0.5}}}, {"KHR_materials_transmission", {{"transmissionFactor", 2}}}}}}));
  EXPECT_EQ(loaded.scene.materials[0].layers->ior, 1);
  EXPECT_EQ(loaded.scene.materials[0].layers->transmission, 1);
  ASSERT_EQ(loaded.warnings.size(), 2U);
  EXPECT_NE(loaded.warnings[0].find("materials[0].extensions.KHR_materials_ior.ior"), std::string::npos);
}

// As writers in JavaScript have them; 3.4028235e38 is a float that is as good as infinite.
TEST(GltfMaterialLayers, WholeNumbersMayBeLarge) {
  const LoadedScene loaded =
      load(scene_with({{"emissiveFactor", {1, 1, 1}},
                       {"extensions",
                        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3000000000}}},
                         {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                         {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 3.4028235e38}}}}}}));
  EXPECT_EQ(loaded.scene.materials[0].emission, (Vec3f{3e9F, 3e9F, 3e9F}));
}

TEST(GltfMaterialLayers, ADiffuseSceneHasNone) {
  LoadedScene loaded = load(scene_with(
      {{"emissiveFactor", {1, 1, 1}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}, {"KHR_materials_unlit", J::object()}}}}));
  EXPECT_TRUE(loaded.scene.materials[0].unlit);
  const Scene diffuse = with_materials(std::move(loaded.scene), {.model = MaterialModel::kDiffuse, .albedo = {}});
  EXPECT_FALSE(diffuse.materials[0].unlit);
  EXPECT_FALSE(diffuse.materials[0].layers);
  EXPECT_EQ(diffuse.materials[0].emission, (Vec3f{0, 0, 0})) << "an unlit surface is no lamp";
}

struct UseCase {
  const char* name;
  J material;  // with {"index": 0, …} somewhere
  const TextureUse& (*use)(const Material&);
};

class GltfTextureTransform : public testing::TestWithParam<UseCase> {};

TEST_P(GltfTextureTransform, AppliesToEveryUse) {
  const Material m = material_of(GetParam().material);
  const TextureUse& use = GetParam().use(m);
  EXPECT_EQ(use.texture, 0);
  EXPECT_EQ(use.uv_set, 1);
  ASSERT_TRUE(use.transformed);
  // Scaled to (1, 0.75), turned by a quarter to (0.75, −1), moved.
  const Vec2f uv = use.transform({0.5F, 0.25F});
  EXPECT_NEAR(uv.x, 0.75F + 0.1F, 1e-6F);
  EXPECT_NEAR(uv.y, -1 + 0.2F, 1e-6F);
}

const J kTransformed = {
    {"index", 0},
    {"texCoord", 0},
    {"extensions",
     {{"KHR_texture_transform",
       {{"offset", {0.1, 0.2}}, {"rotation", 1.5707963267948966}, {"scale", {2, 3}}, {"texCoord", 1}}}}}};

J in_extension(const char* extension, const char* member) {
  return {{"extensions",
           {{extension, {{member, kTransformed}, {"sheenColorFactor", {1, 1, 1}}, {"transmissionFactor", 1}}}}}};
}

INSTANTIATE_TEST_SUITE_P(
    Table, GltfTextureTransform,
    testing::Values(UseCase{"BaseColor",
                            {{"pbrMetallicRoughness", {{"baseColorTexture", kTransformed}}}},
                            [](const Material& m) -> const TextureUse& { return m.base_color_texture; }},
                    UseCase{"Normal",
                            {{"normalTexture", kTransformed}},
                            [](const Material& m) -> const TextureUse& { return m.normal_texture; }},
                    UseCase{"Emissive",
                            {{"emissiveTexture", kTransformed}},
                            [](const Material& m) -> const TextureUse& { return m.emission_texture; }},
                    UseCase{"Transmission", in_extension("KHR_materials_transmission", "transmissionTexture"),
                            [](const Material& m) -> const TextureUse& { return m.layers->transmission_texture; }},
                    UseCase{"SheenRoughness", in_extension("KHR_materials_sheen", "sheenRoughnessTexture"),
                            [](const Material& m) -> const TextureUse& { return m.layers->sheen_roughness_texture; }}),
    test::kByName);

GltfBuilder scene_with_variants() {
  GltfBuilder gltf = triangle_scene();
  gltf.root["materials"] = J::array({{{"name", "own"}}, {{"name", "red"}}, {{"name", "blue"}}});
  gltf.root["extensions"]["KHR_materials_variants"]["variants"] =
      J::array({{{"name", "morning"}}, {{"name", "noon"}}, {{"name", "night"}}});
  gltf.primitive()["material"] = 0;
  gltf.primitive()["extensions"]["KHR_materials_variants"]["mappings"] =
      J::array({{{"material", 1}, {"variants", {0}}}, {{"material", 2}, {"variants", {2}}}});
  return gltf;
}

TEST(GltfVariants, ChooseThePrimitivesMaterials) {
  const auto shown = [](const char* variant) {
    const Scene scene = load(scene_with_variants(), {.animation = {}, .variant = variant}).scene;
    return scene.materials.at(std::size_t(scene.meshes.at(0).material)).name;
  };
  EXPECT_EQ(shown(""), "own");
  EXPECT_EQ(shown("morning"), "red");
  EXPECT_EQ(shown("noon"), "own");
  EXPECT_EQ(shown("night"), "blue");
  EXPECT_EQ(load(scene_with_variants()).variants, (std::vector<std::string>{"morning", "noon", "night"}));
}

TEST(GltfVariants, UnknownOnesAreRefusedWithTheNames) {
  const std::string message = error_of([] { load(scene_with_variants(), {.animation = {}, .variant = "dusk"}); });
  EXPECT_NE(message.find("\"dusk\""), std::string::npos) << message;
  EXPECT_NE(message.find("one of: morning, noon, night"), std::string::npos) << message;
  EXPECT_NE(error_of([] { load(triangle_scene(), {.animation = {}, .variant = "dusk"}); }), "");
}

struct BadMaterial {
  const char* name;
  J material;
  const char* expected;
};

class BadGltfMaterial : public testing::TestWithParam<BadMaterial> {};

TEST_P(BadGltfMaterial, IsRefusedWithItsPlace) {
  const std::string message = error_of([] { load(scene_with(GetParam().material)); });
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
}

J extension(const char* name, const J& value) { return {{"extensions", {{name, value}}}}; }
J transform(const J& value) {
  return {{"normalTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", value}}}}}};
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadGltfMaterial,
    testing::Values(
        BadMaterial{"TextureIndex", extension("KHR_materials_sheen", {{"sheenColorTexture", {{"index", 9}}}}),
                    "KHR_materials_sheen.sheenColorTexture.index: 9 is out of range"},
        BadMaterial{"NoTextureIndex", extension("KHR_materials_sheen", {{"sheenColorTexture", J::object()}}),
                    "sheenColorTexture.index: is missing"},
        BadMaterial{"WordForNumber", extension("KHR_materials_ior", {{"ior", "glass"}}),
                    "KHR_materials_ior.ior: is of the wrong type"},
        BadMaterial{"ShortColor", extension("KHR_materials_specular", {{"specularColorFactor", {1, 1}}}),
                    "specularColorFactor"},
        BadMaterial{"NegativeColor", extension("KHR_materials_specular", {{"specularColorFactor", {1, -1, 1}}}),
                    "specularColorFactor: is -1"},
        BadMaterial{"NoDistance", extension("KHR_materials_volume", {{"attenuationDistance", 0}}),
                    "attenuationDistance: is 0"},
        BadMaterial{"NotAnObject", extension("KHR_materials_clearcoat", 3), "KHR_materials_clearcoat"},
        BadMaterial{"ShortOffset", transform({{"offset", {1}}}), "KHR_texture_transform.offset"},
        BadMaterial{"HugeScale", transform({{"scale", {1e39, 1}}}), "KHR_texture_transform.scale"},
        BadMaterial{"WordForRotation", transform({{"rotation", "left"}}), "KHR_texture_transform.rotation"}),
    test::kByName);

}  // namespace
}  // namespace chiaro::renderer::tests
