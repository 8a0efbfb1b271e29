// EXT_lights_image_based, in files built here. Its faces are those of OpenGL's cube maps, mirrored left to right.

#include "renderer/io/gltf_environment.h"

#include <gtest/gtest.h>

#include "renderer/core/atomic_file.h"
#include "renderer/image/image_file.h"
#include "renderer/image/srgb_curve.h"
#include "renderer/io/light_file.h"
#include "renderer/io/load_gltf.h"
#include "renderer/io/save_gltf.h"
#include "tests/renderer/io/gltf_builder.h"

namespace chiaro::renderer::tests {
namespace {

constexpr int kSize = 16;

// pixel(x, y): R, G, B, A of 0 to 1 as stored.
template <class Pixel>
int add_face(GltfBuilder& gltf, const TemporaryFolder& folder, const Pixel& pixel, int size = kSize) {
  Image image = make_image(size, size, {"R", "G", "B", "A"});
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Vec4f value = pixel(x, y);
      const float channels[4] = {value.x, value.y, value.z, value.w};
      std::copy(channels, channels + 4, image.at(x, y));
    }
  }
  save_image(image, folder / "face.png", PixelType::kUint8);
  gltf.root["images"].push_back(
      {{"bufferView", gltf.add_view(read_file(folder / "face.png"))}, {"mimeType", "image/png"}});
  return int(gltf.root["images"].size()) - 1;
}

void add_light(GltfBuilder& gltf, const ordered_json& faces, ordered_json further = {}) {
  ordered_json light = {{"irradianceCoefficients", ordered_json::array()},
                        {"specularImageSize", kSize},
                        {"specularImages", ordered_json::array({faces})}};
  if (further.is_object()) light.update(further);
  gltf.root["extensionsUsed"] = {"EXT_lights_image_based"};
  gltf.root["extensions"]["EXT_lights_image_based"]["lights"] = ordered_json::array({light});
  gltf.root["scenes"] = {{{"nodes", {0}}, {"extensions", {{"EXT_lights_image_based", {{"light", 0}}}}}}};
  gltf.root["scene"] = 0;
}

// Each face of one grey, 0.1 to 0.6 as stored, alpha `alpha`.
GltfBuilder grey_cube(const TemporaryFolder& folder, float alpha, const ordered_json& further = {}) {
  GltfBuilder gltf = triangle_scene();
  ordered_json faces;
  for (int face = 0; face < 6; ++face) {
    const float grey = 0.1F * float(face + 1);
    faces.push_back(add_face(gltf, folder, [&](int, int) { return Vec4f{grey, grey, grey, alpha}; }));
  }
  add_light(gltf, faces, further);
  return gltf;
}

float stored(int face) { return linear_from_srgb(std::round(25.5F * float(face + 1)) / 255); }

Vec3f seen(const EnvironmentLight& light, Vec3f direction) {
  return light.intensity * look_up(*light.map, latlong_of(normalize(direction)));
}

EnvironmentLight load(const TemporaryFolder& folder, const GltfBuilder& gltf) {
  const LoadedScene loaded = load_gltf(folder.write("scene.glb", gltf.glb()));
  EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings.front();
  return std::get<EnvironmentLight>(loaded.lights.at(0));
}

constexpr Vec3f kFaceDirections[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

TEST(GltfEnvironment, FacesLookTheirWays) {
  const TemporaryFolder folder;
  const EnvironmentLight light = load(folder, grey_cube(folder, 1));
  for (int face = 0; face < 6; ++face) EXPECT_NEAR(seen(light, kFaceDirections[face]).x, stored(face), 1e-4) << face;
}

TEST(GltfEnvironment, AlphaDividesAndIntensityMultiplies) {
  const TemporaryFolder folder;
  const EnvironmentLight light = load(folder, grey_cube(folder, 51.0F / 255, {{"intensity", 10}, {"name", "studio"}}));
  EXPECT_EQ(light.name, "studio");
  for (int face = 0; face < 6; ++face) {
    EXPECT_NEAR(seen(light, kFaceDirections[face]).y / (50 * stored(face)), 1, 1e-3) << face;
  }
}

TEST(GltfEnvironment, TurnsByItsQuaternion) {
  const TemporaryFolder folder;
  // 90 degrees about +X: +Y goes to +Z.
  const float half = std::sqrt(0.5F);
  const EnvironmentLight light = load(folder, grey_cube(folder, 1, {{"rotation", {half, 0, 0, half}}}));
  EXPECT_NEAR(seen(light, {0, 0, 1}).x, stored(2), 1e-4);
  EXPECT_NEAR(seen(light, {1, 0, 0}).x, stored(0), 1e-4);
}

// What a face shows runs on over its edges: a ramp by the direction itself, seen in between everywhere.
TEST(GltfEnvironment, FacesAreAsSeenFromWithin) {
  const TemporaryFolder folder;
  GltfBuilder gltf = triangle_scene();
  // Per face, what lies to the right and downwards in its picture, seen from within with +Y up.
  constexpr Vec3f kRight[] = {{0, 0, 1}, {0, 0, -1}, {-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
  constexpr Vec3f kDown[] = {{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};
  ordered_json faces;
  for (int face = 0; face < 6; ++face) {
    faces.push_back(add_face(gltf, folder, [&](int x, int y) {
      const float s = 2 * (float(x) + 0.5F) / kSize - 1, t = 2 * (float(y) + 0.5F) / kSize - 1;
      const Vec3f d = normalize(kFaceDirections[face] + s * kRight[face] + t * kDown[face]);
      return Vec4f{0.5F + 0.5F * d.x, 0.5F + 0.5F * d.y, 0.5F + 0.5F * d.z, 1};
    }));
  }
  add_light(gltf, faces);
  const EnvironmentLight light = load(folder, gltf);
  for (const Vec3f way : {Vec3f{1, 0.3F, 0.5F}, Vec3f{-0.4F, 0.2F, 1}, Vec3f{0.3F, 1, -0.6F}, Vec3f{-1, -0.9F, 0.8F},
                          Vec3f{0.2F, -1, 0.4F}, Vec3f{-0.6F, 0.1F, -1}}) {
    const Vec3f d = normalize(way), color = seen(light, d);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], linear_from_srgb(0.5F + 0.5F * d[c]), 0.03) << d.x << " " << c;
  }
}

TEST(GltfEnvironment, IsKeptInTheFilesThatASceneIsSavedTo) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.glb", grey_cube(folder, 1).glb());
  save_gltf_with_lights(scene, {PointLight{"key", {1, 2, 3}, {4, 4, 4}}}, folder / "lit.glb", {});
  EXPECT_EQ(load_gltf(folder / "lit.glb").lights.size(), 2U);
  EXPECT_EQ(load_lights(folder / "lit.glb").size(), 2U);
}

TEST(GltfEnvironment, RefusesBrokenCubes) {
  const TemporaryFolder folder;
  const auto error = [&](const GltfBuilder& gltf) {
    return error_of([&] { load_gltf(folder.write("bad.glb", gltf.glb())); });
  };
  GltfBuilder five = grey_cube(folder, 1);
  five.root["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImages"][0].erase(5);
  EXPECT_NE(error(five).find("no level of six faces"), std::string::npos);
  EXPECT_NE(error(grey_cube(folder, 1, {{"intensity", 1e25}})).find("too bright"), std::string::npos);
  GltfBuilder out_of_range = grey_cube(folder, 1);
  out_of_range.root["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImages"][0][2] = 77;
  EXPECT_NE(error(out_of_range).find("77 is out of range"), std::string::npos);
  GltfBuilder no_light = grey_cube(folder, 1);
  no_light.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 3;
  EXPECT_NE(error(no_light).find("3 is out of range"), std::string::npos);
  GltfBuilder uneven = grey_cube(folder, 1);
  const int small = add_face(
      uneven, folder,
      [](int, int) {
        return Vec4f{1, 1, 1, 1};
      },
      8);
  uneven.root["extensions"]["EXT_lights_image_based"]["lights"][0]["specularImages"][0][5] = small;
  EXPECT_NE(error(uneven).find("8 x 8 pixels"), std::string::npos) << error(uneven);
}

}  // namespace
}  // namespace chiaro::renderer::tests
