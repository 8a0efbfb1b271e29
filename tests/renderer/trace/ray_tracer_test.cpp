#include "renderer/trace/ray_tracer.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"
#include "renderer/trace/surface_point.h"
#include "tests/support/code_scenes.h"
#include "tests/support/directions.h"

namespace chiaro::renderer {
namespace {

using test::add_mesh;
using test::lambert;
using test::rectangle;
using test::uniform_direction;

Mat4f turned(Vec3f translation, Vec3f scale) {
  return make_transform(translation, {0.18257419F, 0.36514837F, 0.54772256F, 0.73029674F}, scale);
}

// One mesh drawn four times: moved, stretched, mirrored, and tiny.
Scene instanced_scene() {
  Scene scene;
  add_mesh(scene, test::sphere({0.1F, 0, 0}, 1, 8), lambert({0.5F, 0.5F, 0.5F}), "ball");
  scene.instances[0].world_from_object = turned({-3, 0, 0}, {1, 1, 1});
  scene.instances.push_back({"stretched", 0, turned({0, 0, 0}, {0.4F, 1.5F, 1})});
  scene.instances.push_back({"mirrored", 0, turned({3, 0, 0}, {-1, 1.3F, 0.7F})});
  scene.instances.push_back({"tiny", 0, turned({0, 3, 0}, {1e-3F, 1e-3F, -1e-3F})});
  return scene;
}

// The same triangles in world space, a mesh each. As glTF has it, a mirrored instance turns its triangles round.
Scene flattened(const Scene& scene) {
  Scene flat;
  for (const Instance& instance : scene.instances) {
    Mesh mesh = scene.meshes[instance.mesh];
    for (Vec3f& p : mesh.positions) p = transform_point(instance.world_from_object, p);
    for (Vec3f& n : mesh.normals) n = transform_normal(instance.world_from_object, n);
    if (determinant3(instance.world_from_object) < 0) {
      for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    add_mesh(flat, std::move(mesh), lambert({0.5F, 0.5F, 0.5F}), instance.name);
  }
  return flat;
}

// Rays towards the neighbourhood of every instance.
std::vector<Ray> rays_at(const Scene& scene, int per_instance) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Mat4f& m = scene.instances[i].world_from_object;
    for (int k = 0; k < per_instance; ++k) {
      Sampler sampler(1, i, std::uint32_t(k));
      const Vec3f from = transform_point(m, 3 * uniform_direction(sampler.next_2d()));
      const Vec3f to = transform_point(m, 0.9F * uniform_direction(sampler.next_2d()));
      rays.push_back({from, normalize(to - from), 0, kInfinity, 0});
    }
  }
  return rays;
}

TEST(RayTracer, InstancesEqualFlattenedCopies) {
  const Scene scene = instanced_scene(), flat = flattened(scene);
  const RayTracer a(scene), b(flat);
  int hits = 0, differences = 0;
  for (const Ray& ray : rays_at(scene, 1000)) {
    const auto x = a.intersect(ray), y = b.intersect(ray);
    EXPECT_EQ(x.has_value(), a.occluded(ray));
    EXPECT_EQ(y.has_value(), b.occluded(ray));
    if (!x || !y || x->triangle != y->triangle || x->instance != y->instance) {
      differences += x.has_value() || y.has_value() ? 1 : 0;
      continue;
    }
    ++hits;
    // Coordinates of 3 m have steps of 2.4e-7, and a grazing ray makes more of them.
    const float rounding = 2e-6F / std::abs(dot(ray.direction, y->geometric_normal));
    EXPECT_NEAR(x->distance, y->distance, 1e-4F * y->distance + rounding);
    EXPECT_GT(dot(x->geometric_normal, y->geometric_normal), 0.9999F);
    EXPECT_NEAR(length(x->geometric_normal), 1, 1e-5F);
    const SurfacePoint p = make_surface_point(scene, ray, *x), q = make_surface_point(flat, ray, *y);
    EXPECT_LT(length(p.position - q.position), 1e-5F);
    // Blending the corners' normals before or after an uneven scale is not the same.
    const bool even = x->instance == 0 || x->instance == 3;
    EXPECT_GT(dot(p.shading_normal, q.shading_normal), even ? 0.9999F : 0.95F);
    EXPECT_EQ(p.front, q.front);
  }
  EXPECT_GT(hits, 3900);
  EXPECT_LE(differences, 8);  // rays through edges and silhouettes
}

TEST(RayTracer, NormalsPointOutOfASolidHoweverItIsPlaced) {
  // Drawn once (and so flattened by the tracer) or twice (and so instanced), mirrored or not.
  for (const int copies : {1, 2}) {
    for (const float mirror : {1.0F, -1.0F}) {
      Scene scene;
      add_mesh(scene, test::sphere({0, 0, 0}, 1, 8), lambert({0.5F, 0.5F, 0.5F}), "ball");
      scene.instances[0].world_from_object = turned({1, 2, 3}, {mirror, 0.5F, 2});
      if (copies == 2) scene.instances.push_back({"far", 0, turned({100, 0, 0}, {1, 1, 1})});
      const RayTracer tracer(scene);
      for (std::uint32_t k = 0; k < 200; ++k) {
        Sampler sampler(2, 0, k);
        const Vec3f direction = uniform_direction(sampler.next_2d());
        const auto hit = tracer.intersect({Vec3f{1, 2, 3}, direction, 0, 50, 0});
        ASSERT_TRUE(hit);
        EXPECT_GT(dot(hit->geometric_normal, direction), 0);
        EXPECT_EQ(hit->instance, 0U);
      }
    }
  }
}

TEST(RayTracer, TrianglesWhoseAreaIsHardlyAFloatHaveANormal) {
  int hits = 0;
  for (const float width : {1e-25F, 1e-38F, 8e-39F, 1e-43F}) {
    for (const bool instanced : {false, true}) {
      Scene scene;
      add_mesh(scene, rectangle({0, 0, 0}, {width, 0, 0}, {0, 0, 2}), lambert({0.5F, 0.5F, 0.5F}), "sliver");
      if (instanced) scene.instances.push_back({"again", 0, make_transform({5, 0, 0}, {0, 0, 0, 1}, {1, 1, 1})});
      const RayTracer tracer(scene);
      for (const Vec3f direction :
           {Vec3f{0, -1, 0}, normalize({0.88F, 0.31F, 0.36F}), normalize({0.3F, -0.8F, 0.2F})}) {
        const Ray ray{-0.5F * direction + Vec3f{0, 0, 1}, direction, 0, kInfinity, 0};
        const auto hit = tracer.intersect(ray);
        if (!hit) continue;  // as if it were not there
        ++hits;
        EXPECT_NEAR(length(hit->geometric_normal), 1, 1e-5F) << width;
        EXPECT_TRUE(is_finite(point_behind(make_surface_point(scene, ray, *hit)))) << width;
      }
    }
  }
  EXPECT_GT(hits, 0);
}

TEST(RayTracer, NearAndFarAreKept) {
  Scene scene;
  add_mesh(scene, rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), lambert({1, 1, 1}), "plane");
  const RayTracer tracer(scene);
  EXPECT_TRUE(tracer.intersect({{0.1F, 2, 0.2F}, {0, -1, 0}, 0, 2.01F, 0}));
  EXPECT_FALSE(tracer.intersect({{0.1F, 2, 0.2F}, {0, -1, 0}, 0, 1.99F, 0}));
  EXPECT_FALSE(tracer.intersect({{0.1F, 2, 0.2F}, {0, -1, 0}, 2.01F, kInfinity, 0}));
  EXPECT_TRUE(tracer.occluded_between({0.1F, 1, 0.2F}, {0.1F, -1, 0.2F}, 0));
  EXPECT_FALSE(tracer.occluded_between({0.1F, 1, 0.2F}, {0.4F, 0.1F, 0.2F}, 0));
  EXPECT_EQ(tracer.bounds().extent(), (Vec3f{2, 0, 2}));
}

// A wall across z = depth whose vertex alpha grows from 0 at x = 0 to 1 at x = 1.
Mesh fading_wall(float depth) {
  Mesh wall = rectangle({0, 0, depth}, {1, 0, 0}, {0, 1, 0});
  for (const Vec3f p : wall.positions) wall.colors.push_back({1, 1, 1, p.x});
  return wall;
}

TEST(RayTracer, AlphaMaskCutsWhereAlphaIsBelowTheCutoff) {
  Scene scene;
  Material material = lambert({1, 1, 1});
  material.alpha_mode = AlphaMode::kMask;
  material.alpha_cutoff = 0.25F;
  material.alpha = 0.5F;  // times the vertices': the cut is at x = 0.5
  add_mesh(scene, fading_wall(0), material, "wall");
  const RayTracer tracer(scene);
  for (float x = 0.005F; x < 1; x += 0.01F) {
    const Ray ray{{x, 0.37F, 1}, {0, 0, -1}, 0, kInfinity, 0};
    EXPECT_EQ(tracer.intersect(ray).has_value(), x >= 0.5F) << x;
    EXPECT_EQ(tracer.occluded(ray), x >= 0.5F) << x;
  }
}

TEST(RayTracer, BlendedSurfacesStopTheirAlphaOfAllRays) {
  // Two walls of alpha x, one behind the other; as instances of one mesh and as meshes of their own.
  for (const bool instanced : {false, true}) {
    Scene scene;
    Material material = lambert({1, 1, 1});
    material.alpha_mode = AlphaMode::kBlend;
    add_mesh(scene, fading_wall(0), material, "front");
    if (instanced) {
      scene.instances.push_back({"back", 0, make_transform({0, 0, -1}, {0, 0, 0, 1}, {1, 1, 1})});
    } else {
      add_mesh(scene, fading_wall(-1), material, "back");
    }
    const RayTracer tracer(scene);
    constexpr int kRays = 20000;
    for (const float x : {0.3F, 0.75F}) {
      int front = 0, back = 0;
      for (std::uint32_t seed = 0; seed < kRays; ++seed) {
        const Ray ray{{x, 0.37F, 1}, {0, 0, -1}, 0, kInfinity, seed};
        const auto hit = tracer.intersect(ray);
        front += hit && hit->instance == 0 ? 1 : 0;
        back += hit && hit->instance == 1 ? 1 : 0;
        ASSERT_EQ(hit.has_value(), tracer.occluded(ray)) << "shadows and views must agree, seed " << seed;
      }
      // Four standard deviations of a binomial, p < 0.01 %.
      const auto expect_share = [](int count, double share) {
        EXPECT_NEAR(double(count) / kRays, share, 4 * std::sqrt(share * (1 - share) / kRays));
      };
      expect_share(front, double(x));
      expect_share(back, double(x) * (1 - double(x)));
    }
  }
}

// Panes across each other: of coloured glass, and blended ones of which some are drawn twice; and many long ones of one
// mesh.
Scene translucent_scene() {
  Scene scene;
  Material blended = lambert({1, 1, 1}), glass = lambert({0.9F, 0.8F, 0.3F});
  blended.alpha_mode = AlphaMode::kBlend;
  glass.layers.emplace().transmission = 0.7F;
  glass.roughness = 0;
  Mesh many;
  for (std::uint32_t k = 0; k < 324; ++k) {
    Sampler sampler(12, 0, k);
    const Vec3f a = uniform_direction(sampler.next_2d()), b = uniform_direction(sampler.next_2d());
    if (k >= 24) {
      const auto first = std::uint32_t(many.positions.size());
      for (const Vec3f p : {-1.5F * a, 1.5F * a, 1.5F * a + 0.1F * b}) {
        many.positions.push_back(p);
        many.normals.push_back(b);
      }
      many.triangles.push_back({first, first + 1, first + 2});
      continue;
    }
    blended.alpha = 0.1F + 0.5F * sampler.next_1d();
    add_mesh(scene, rectangle(-1.5F * (a + 0.2F * b), 3 * a, 0.6F * b), k % 3 == 0 ? glass : blended, "pane");
    if (k % 2 == 0) scene.instances.push_back({"again", int(k), turned({0.1F, 0, 0}, {1, 1, 1})});
  }
  blended.alpha = 0.1F;
  add_mesh(scene, std::move(many), blended, "many");
  return scene;
}

TEST(RayTracer, TransmittanceIsWhatRaysPassOnAverage) {
  const Scene scene = translucent_scene();
  const RayTracer tracer(scene);
  constexpr int kSeeds = 4000, kPairs = 60;
  int partly = 0;
  for (std::uint32_t k = 0; k < kPairs; ++k) {
    Sampler sampler(13, 0, k);
    const Vec3f from = 2 * uniform_direction(sampler.next_2d());
    const Vec3f to = 0.5F * uniform_direction(sampler.next_2d());
    int passed = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) passed += tracer.occluded_between(from, to, seed) ? 0 : 1;
    const double through = double(tracer.transmittance_between(from, to));
    // Four and a half standard deviations of a binomial: of 60 pairs, p < 0.05 % that any fails by chance.
    EXPECT_NEAR(double(passed) / kSeeds, through, 4.5 * std::sqrt(through * (1 - through) / kSeeds) + 1e-6);
    partly += through > 0.01 && through < 0.9 ? 1 : 0;
  }
  EXPECT_GT(partly, kPairs / 3);
}

constexpr float kUlp = 0x1p-23F;  // of a number, at most

// A plane, drawn once or as one of two instances.
struct PlaneCase {
  Vec3f normal, center;
  float size;          // metres
  float flatness = 1;  // 1: two right-angled triangles; less: obtuse ones, so many times as high
  bool instanced = false;
};

Scene plane_scene(const PlaneCase& plane) {
  const Frame3f frame(plane.normal);
  const Vec3f u = plane.size * frame.tangent;
  const Vec3f v = plane.size * (plane.flatness * frame.bitangent + (plane.flatness < 1 ? 0.5F : 0) * frame.tangent);
  Scene scene;
  add_mesh(scene, rectangle(plane.center - 0.5F * (u + v), u, v), lambert({1, 1, 1}), "plane");
  if (!plane.instanced) return scene;
  const Mat4f world_from_object = turned({-2 * plane.size, plane.size, 0}, {2, 0.5F, -0.1F});
  for (Vec3f& p : scene.meshes[0].positions) p = transform_point(inverse_affine(world_from_object), p);
  scene.instances[0].world_from_object = world_from_object;
  scene.instances.push_back({"far", 0, turned({1e3F * plane.size, 0, 0}, {1, 1, 1})});
  return scene;
}

// How many of so many random views of a plane from `distance` meet a point from which rays, off at all angles or back
// to the eye, meet the plane again.
int points_that_hide_themselves(const PlaneCase& plane, int views, float distance) {
  const Scene scene = plane_scene(plane);
  const RayTracer tracer(scene);
  const Frame3f frame(plane.normal);
  int hidden = 0, hits = 0;
  for (std::uint32_t k = 0; k < std::uint32_t(views); ++k) {
    Sampler s(4, 0, k);
    const Vec2f place = s.next_2d();
    const float spread = k % 4 == 0 ? 1e-3F : 0.8F;
    const Vec3f at =
        plane.center +
        spread * plane.size * ((place.x - 0.5F) * frame.tangent + plane.flatness * (place.y - 0.5F) * frame.bitangent);
    const Vec3f eye = at + distance * normalize(plane.normal + 0.95F * uniform_direction(s.next_2d()));
    const Ray ray{eye, normalize(at - eye), 0, kInfinity, 0};
    const auto hit = tracer.intersect(ray);
    if (!hit || hit->instance != 0) continue;
    ++hits;
    const SurfacePoint point = make_surface_point(scene, ray, *hit);
    const Vec3f origin = offset_point(point.position, point.geometric_normal, point.rounding);
    const Vec2f u = s.next_2d();
    const Vec3f local = k % 2 == 0 ? sample_cosine_hemisphere(u) : uniform_direction({0.5F - 0.01F * u.x, u.y});
    const Vec3f away = normalize(Frame3f(point.geometric_normal).world_from_local(local));
    hidden += tracer.occluded({origin, away, 0, kInfinity, 0}) || tracer.occluded_between(origin, eye, 0) ? 1 : 0;
  }
  EXPECT_GT(hits, views / 8);
  return hidden;
}

TEST(OffsetPoint, NoPlaneHidesItselfWhateverItsSizeNearOrFarFromTheOrigin) {
  for (const float unit : {1e-3F, 1.0F, 1e3F}) {
    for (const float size : {3 * unit, 9 * unit, 30 * unit}) {
      for (std::uint32_t i = 0; i < 24; ++i) {
        Sampler s(3, 0, i);
        const Vec3f normal = uniform_direction(s.next_2d()), toward = uniform_direction(s.next_2d());
        const float distance = std::array{0.0F, 0.01F, 1.0F, 20.0F}[i % 4];
        const PlaneCase plane{normal, distance * unit * toward, size, 1, i % 8 >= 4};
        EXPECT_EQ(points_that_hide_themselves(plane, 1000, unit), 0) << size << " m, case " << i;
      }
    }
  }
}

TEST(OffsetPoint, NoObtuseTriangleHidesItself) {
  for (std::uint32_t i = 0; i < 24; ++i) {
    Sampler s(5, 0, i);
    const Vec3f normal = uniform_direction(s.next_2d()), center = 0.3F * uniform_direction(s.next_2d());
    const PlaneCase plane{normal, center, 1, 0.05F, i % 2 == 1};
    EXPECT_EQ(points_that_hide_themselves(plane, 1000, 1), 0) << "case " << i;
  }
}

TEST(OffsetPoint, IsAFewUnitsInTheLastPlaceOfTheTrianglesCoordinates) {
  for (const float unit : {1e-3F, 1.0F, 1e3F}) {
    const Scene scene = plane_scene({normalize(Vec3f{1, 2, 3}), {0, 0, 5 * unit}, 3 * unit});
    const RayTracer tracer(scene);
    const Ray ray{{0.1F * unit, 0.1F * unit, 9 * unit}, {0, 0, -1}, 0, kInfinity, 0};
    const auto hit = tracer.intersect(ray);
    ASSERT_TRUE(hit);
    const SurfacePoint point = make_surface_point(scene, ray, *hit);
    const float offset = length(offset_point(point.position, point.geometric_normal, point.rounding) - point.position);
    EXPECT_GT(offset, 2 * kUlp * 5 * unit);
    EXPECT_LT(offset, 8 * kUlp * 7 * unit);
  }
}

TEST(OffsetPoint, WallsMuchThinnerThanTheSceneKeepTheLightOut) {
  // A plate, its sides 1e-5 of its size apart, tilted.
  for (const float unit : {1e-3F, 1.0F, 1e3F}) {
    const Frame3f frame(normalize(Vec3f{1, 2, 3}));
    const Vec3f u = 9 * unit * frame.tangent, v = 9 * unit * frame.bitangent, depth = 9e-5F * unit * frame.normal;
    Scene scene;
    add_mesh(scene, rectangle(-0.5F * (u + v), u, v), lambert({1, 1, 1}), "lit");
    add_mesh(scene, rectangle(-0.5F * (u + v) - depth, v, u), lambert({1, 1, 1}), "dark");
    const RayTracer tracer(scene);
    for (std::uint32_t k = 0; k < 2000; ++k) {
      Sampler s(6, 0, k);
      const Vec2f place = s.next_2d();
      const Vec3f at = 0.8F * ((place.x - 0.5F) * u + (place.y - 0.5F) * v);
      const Ray from_behind{at - unit * frame.normal, frame.normal, 0, kInfinity, 0};
      const auto hit = tracer.intersect(from_behind);
      ASSERT_TRUE(hit);
      const SurfacePoint point = make_surface_point(scene, from_behind, *hit);
      const Vec3f origin = offset_point(point.position, point.geometric_normal, point.rounding);
      const Vec3f light = at + unit * normalize(frame.normal + 0.7F * uniform_direction(s.next_2d()));
      ASSERT_TRUE(tracer.occluded_between(origin, light, 0)) << k;
    }
  }
}

TEST(OffsetPoint, NoFalseShadowsInTheCornersOfARoom) {
  // A room with a corner in the origin; points a ten-thousandth from edges and corners, lights all over.
  Scene scene;
  add_mesh(scene, test::room({4, 3, 4}), lambert({1, 1, 1}), "room");
  const RayTracer tracer(scene);
  for (std::uint32_t k = 0; k < 500; ++k) {
    Sampler s(5, 0, k);
    const Vec2f place = s.next_2d(), across = s.next_2d();
    const Vec3f light{0.1F + 3.8F * place.x, 0.1F + 2.8F * place.y, 0.1F + 3.8F * s.next_1d()};
    for (const Vec3f p :
         {Vec3f{0, 1e-4F, 5e-5F}, Vec3f{0, 1e-4F, 4 * across.x}, Vec3f{0, 3 * across.x, 4 * across.y}}) {
      const Vec3f origin = offset_point(p, {1, 0, 0}, surface_rounding(4, 2.5F));
      EXPECT_FALSE(tracer.occluded_between(light, origin, 0)) << p.y << ", " << p.z;
      EXPECT_FALSE(tracer.occluded_between(origin, light, 0)) << p.y << ", " << p.z;
    }
  }
}

// The camera in each ball sees out of it, and into none; all other rays meet the inside.
TEST(RayTracer, HiddenBacksAreHiddenFromCamerasAlone) {
  Scene alone;
  add_mesh(alone, test::sphere({0.1F, 0, 0}, 1, 8), lambert({0.5F, 0.5F, 0.5F}), "ball");
  alone.instances[0].world_from_object = turned({0, 0, 0}, {1, -1, 1});
  for (Scene scene : {instanced_scene(), flattened(instanced_scene()), alone}) {
    for (Material& material : scene.materials) material.hidden_back = true;
    const RayTracer tracer(scene);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
      Vec3f center;
      for (const Vec3f& p : mesh.positions) center += p / float(mesh.positions.size());
      center = transform_point(scene.instances[i].world_from_object, center);
      Ray out{center, {0, 0, 1}};
      const auto inside = tracer.intersect(out);
      ASSERT_TRUE(inside);
      EXPECT_EQ(inside->instance, i);
      out.of_camera = true;
      const auto beyond = tracer.intersect(out);
      EXPECT_TRUE(!beyond || beyond->instance != i);
      Ray in{center + 10 * inside->distance * out.direction, {0, 0, -1}};
      const auto front = tracer.intersect(in);
      in.of_camera = true;
      const auto seen = tracer.intersect(in);
      ASSERT_TRUE(front && seen);
      EXPECT_EQ(front->distance, seen->distance);
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer
