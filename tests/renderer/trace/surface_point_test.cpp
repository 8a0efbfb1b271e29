#include "renderer/trace/surface_point.h"

#include <gtest/gtest.h>

#include "tests/support/code_scenes.h"

namespace chiaro::renderer {
namespace {

using test::add_mesh;
using test::rectangle;

void expect_near(Vec3f a, Vec3f b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

Texture one_texel(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a = 255) {
  return {"", 1, 1, {r, g, b, a}};
}

// A unit square in the plane y = 0, facing up; u grows along +X, v along +Z (down in the texture).
Mesh square() {
  Mesh mesh = rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  for (const Vec3f p : mesh.positions) mesh.uv[0].push_back({p.x, p.z});
  return mesh;
}

Scene square_scene(const Material& material, std::vector<Texture> textures = {}) {
  Scene scene;
  add_mesh(scene, square(), material, "square");
  scene.textures = std::move(textures);
  return scene;
}

// What a ray through (x, 0, z) meets.
SurfacePoint seen(const Scene& scene, Vec3f at, Vec3f direction) {
  const RayTracer tracer(scene);
  const Ray ray{at - direction, normalize(direction), 0, kInfinity, 0};
  const auto hit = tracer.intersect(ray);
  EXPECT_TRUE(hit);
  return hit ? make_surface_point(scene, ray, *hit) : SurfacePoint{};
}

TEST(SurfacePoint, FacesTheSideThatTheRayCameFrom) {
  const Scene scene = square_scene(test::lambert({0.5F, 0.5F, 0.5F}));
  const SurfacePoint above = seen(scene, {0.3F, 0, 0.6F}, {0.1F, -1, 0.2F});
  EXPECT_TRUE(above.front);
  expect_near(above.position, {0.3F, 0, 0.6F}, 1e-6F);
  expect_near(above.geometric_normal, {0, 1, 0}, 1e-6F);
  expect_near(above.shading_normal, {0, 1, 0}, 1e-6F);
  const SurfacePoint below = seen(scene, {0.3F, 0, 0.6F}, {0.1F, 1, 0.2F});
  EXPECT_FALSE(below.front);
  expect_near(below.geometric_normal, {0, -1, 0}, 1e-6F);
  expect_near(below.shading_normal, {0, -1, 0}, 1e-6F);
}

// On a ground of 20 km, whose barycentric floats tell places to a millimetre.
TEST(SurfacePoint, OfALargeTriangleIsWhereTheRayMeetsIt) {
  constexpr float kHalf = 1e4F;
  Scene scene;
  add_mesh(scene, rectangle({-kHalf, 0, -kHalf}, {0, 0, 2 * kHalf}, {2 * kHalf, 0, 0}), test::lambert({1, 1, 1}), "g");
  for (const Vec3f direction : {Vec3f{0, -1, 0}, Vec3f{3, -1, 1}, Vec3f{-1, 2, 4}}) {
    for (int i = 0; i < 100; ++i) {
      const Vec3f at{0.013F * float(i) - 0.7F, 0, 0.3F - 0.017F * float(i)};
      expect_near(seen(scene, at, direction).position, at, 1e-6F);
    }
  }
}

TEST(SurfacePoint, VertexColoursAreBlendedAndMultiplyTheBaseColour) {
  Scene scene = square_scene(test::lambert({0.5F, 1, 1}));
  for (const Vec3f p : scene.meshes[0].positions) scene.meshes[0].colors.push_back({p.x, p.z, 3, 1});
  const SurfacePoint point = seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0});
  expect_near(point.base_color, {0.15F, 0.6F, 1}, 1e-5F);  // no surface sends back more than it gets
  scene.materials[0].constant_base_color = true;
  expect_near(seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0}).base_color, {0.5F, 1, 1}, 1e-6F);
}

Material normal_mapped(float scale) {
  Material material = test::lambert({0.5F, 0.5F, 0.5F});
  material.normal_texture.texture = 0;
  material.normal_scale = scale;
  return material;
}

// Tangent 0.6, bitangent 0, normal 0.8, as nearly as 8 bits tell.
const Texture kLeaning = one_texel(204, 128, 230);

TEST(SurfacePoint, NormalMapsLeanAlongTheTextureFromBothSides) {
  const Scene scene = square_scene(normal_mapped(1), {kLeaning});
  expect_near(seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0}).shading_normal, {0.6F, 0.8F, 0}, 0.01F);
  expect_near(seen(scene, {0.3F, 0, 0.6F}, {0, 1, 0}).shading_normal, {-0.6F, -0.8F, 0}, 0.01F);
}

TEST(SurfacePoint, MirroredTextureCoordinatesTurnTheLeanRound) {
  Scene scene = square_scene(normal_mapped(1), {kLeaning});
  for (Vec2f& uv : scene.meshes[0].uv[0]) uv.x = -uv.x;
  expect_near(seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0}).shading_normal, {-0.6F, 0.8F, 0}, 0.01F);
}

TEST(SurfacePoint, UpInANormalMapIsAgainstGrowingV) {
  // glTF: +Y of tangent space is up in the picture, and v grows downwards.
  Scene scene = square_scene(normal_mapped(1), {one_texel(128, 204, 230)});
  for (std::size_t i = 0; i < 4; ++i) scene.meshes[0].tangents.push_back({1, 0, 0, 1});
  // cross(normal, tangent) · w = cross(+Y, +X) = -Z, where v falls.
  expect_near(seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0}).shading_normal, {0, 0.8F, -0.6F}, 0.01F);
  // Without tangents in the file the handedness follows from the coordinates.
  scene.meshes[0].tangents.clear();
  expect_near(seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0}).shading_normal, {0, 0.8F, -0.6F}, 0.01F);
}

// As far over its triangle's horizon as maps and vertex normals may lean a normal, it stays on the side that it leans
// to.
TEST(SurfacePoint, NormalsBeyondTheHorizonLeanTheSameWay) {
  for (const float tilt : {0.2F, 0.6F, 0.9F}) {
    Scene scene = square_scene(normal_mapped(1), {one_texel(250, 128, 150)});  // 80 degrees to +X
    for (Vec3f& n : scene.meshes[0].normals) n = {std::sin(tilt), std::cos(tilt), 0};
    for (const Vec3f direction : {Vec3f{0, -1, 0}, Vec3f{0.5F, -1, 0}, Vec3f{-0.5F, -1, 0}}) {
      const SurfacePoint point = seen(scene, {0.3F, 0, 0.6F}, direction);
      EXPECT_GT(point.shading_normal.x, 0.2F) << tilt << ' ' << direction.x;
      EXPECT_GT(point.shading_normal.y, 0) << tilt << ' ' << direction.x;
    }
    EXPECT_LT(seen(scene, {0.3F, 0, 0.6F}, {0, 1, 0}).shading_normal.x, -0.2F) << tilt;
  }
}

// KHR_materials_clearcoat: emission × (1 − clearcoat · (0.04 + 0.96 (1 − cosθ)⁵)).
TEST(SurfacePoint, AClearcoatDarkensWhatIsEmittedBelowIt) {
  Material material = test::lambert({0, 0, 0}, {1, 2, 3});
  material.lambert = false;
  material.layers.emplace();
  for (const float clearcoat : {0.0F, 0.5F, 1.0F}) {
    material.layers->clearcoat = clearcoat;
    const Scene scene = square_scene(material);
    for (const float angle : {0.0F, 1.0F, 1.4F}) {
      const float left = 1 - clearcoat * (0.04F + 0.96F * std::pow(1 - std::cos(angle), 5.0F));
      const Vec3f direction{std::sin(angle), -std::cos(angle), 0};
      expect_near(seen(scene, {0.3F, 0, 0.6F}, direction).emission, left * Vec3f{1, 2, 3}, 1e-3F);
    }
  }
}

TEST(SurfacePoint, NormalScaleFlattensTheMap) {
  const Scene scene = square_scene(normal_mapped(0.5F), {kLeaning});
  expect_near(seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0}).shading_normal, normalize(Vec3f{0.3F, 0.8F, 0}), 0.01F);
}

TEST(SurfacePoint, NormalMapsFollowTheirInstance) {
  Scene scene = square_scene(normal_mapped(1), {kLeaning});
  // Mirrored in x: the texture's u runs along -X in the world.
  scene.instances[0].world_from_object = make_transform({}, {0, 0, 0, 1}, {-1, 1, 1});
  expect_near(seen(scene, {-0.3F, 0, 0.6F}, {0, -1, 0}).shading_normal, {-0.6F, 0.8F, 0}, 0.01F);
}

TEST(SurfacePoint, ShadingNormalReflectsTheRayOffTheSurface) {
  const Scene scene = square_scene(normal_mapped(1), {one_texel(250, 128, 150)});
  for (const float slope : {-3.0F, -0.5F, -0.1F, -0.02F, 0.02F, 0.1F, 0.5F, 3.0F}) {
    for (const float along : {-1.0F, 1.0F}) {
      const Vec3f direction = normalize(Vec3f{along, slope, 0.3F});
      const SurfacePoint point = seen(scene, {0.3F, 0, 0.6F}, direction);
      EXPECT_GT(dot(point.shading_normal, -direction), 0) << slope;
      // The ray, reflected about it, leaves the surface.
      const Vec3f reflected = 2 * dot(point.shading_normal, -direction) * point.shading_normal + direction;
      const float cosine = dot(point.geometric_normal, -direction);
      EXPECT_GE(dot(point.geometric_normal, reflected), std::min(0.01F, 0.9F * cosine) - 1e-5F) << slope;
      EXPECT_GT(dot(point.geometric_normal, -direction), 0) << slope;
      EXPECT_NEAR(length(point.shading_normal), 1, 1e-5F);
    }
  }
}

TEST(SurfacePoint, RoughnessAndMetalAreFactorsTimesTheirTexture) {
  Material material;
  material.metallic = 0.5F;
  material.roughness = 0.8F;
  material.metallic_roughness_texture.texture = 0;
  const SurfacePoint point = seen(square_scene(material, {one_texel(0, 51, 102)}), {0.3F, 0, 0.6F}, {0, -1, 0});
  EXPECT_NEAR(point.roughness, 0.8F * 0.2F, 1e-5F);  // green
  EXPECT_NEAR(point.metallic, 0.5F * 0.4F, 1e-5F);   // blue
}

TEST(SurfacePoint, EmissionIsItsFactorTimesItsTextureInLinearLight) {
  Material material = test::lambert({0, 0, 0}, {100, 200, 300});
  material.emission_texture.texture = 0;
  const Scene scene = square_scene(material, {one_texel(255, 188, 0)});
  const Vec3f emission = seen(scene, {0.3F, 0, 0.6F}, {0, -1, 0}).emission;
  EXPECT_NEAR(emission.x, 100, 1e-3F);
  EXPECT_NEAR(emission.y, 200 * 0.502887F, 0.01F);  // ((188 / 255 + 0.055) / 1.055)^2.4
  EXPECT_EQ(emission.z, 0);
}

TEST(SurfacePoint, AlphaIsTheProductOfFactorTextureAndVertices) {
  Material material = test::lambert({1, 1, 1});
  material.alpha = 0.5F;
  material.base_color_texture.texture = 0;
  Scene scene = square_scene(material, {one_texel(255, 255, 255, 102)});
  scene.meshes[0].colors.assign(4, {1, 1, 1, 0.5F});
  EXPECT_NEAR(surface_alpha(scene, scene.meshes[0], 0, 0.2F, 0.3F), 0.5F * 0.4F * 0.5F, 1e-6F);
}

}  // namespace
}  // namespace chiaro::renderer
