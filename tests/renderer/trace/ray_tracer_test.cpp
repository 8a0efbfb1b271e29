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

// Planes of all directions through points `distance` from the origin, 3 × `scale` across; none may hide its own points.
void expect_no_self_intersection(float scale, float distance) {
  for (std::uint32_t plane = 0; plane < 20; ++plane) {
    Sampler sampler(3, plane, 0);
    const Vec3f n = uniform_direction(sampler.next_2d());
    const Vec3f center = distance * uniform_direction(sampler.next_2d());
    const Frame3f frame(n);
    const Vec3f u = 3 * scale * frame.tangent, v = 3 * scale * frame.bitangent;
    Scene scene;
    add_mesh(scene, rectangle(center - 0.5F * (u + v), u, v), lambert({1, 1, 1}), "plane");
    const RayTracer tracer(scene);
    for (std::uint32_t k = 0; k < 500; ++k) {
      Sampler s(4, plane, k);
      const Vec2f place = s.next_2d();
      const float spread = k % 2 == 0 ? 0.8F : 1e-3F;
      const Vec3f at = center + spread * ((place.x - 0.5F) * u + (place.y - 0.5F) * v);
      const Vec3f eye = at + scale * normalize(n + 0.9F * uniform_direction(s.next_2d()));
      const auto hit = tracer.intersect({eye, normalize(at - eye), 0, kInfinity, 0});
      if (!hit) continue;
      const SurfacePoint point = make_surface_point(scene, {eye, normalize(at - eye), 0, kInfinity, 0}, *hit);
      const Vec3f origin = offset_point(point.position, point.geometric_normal);
      EXPECT_LT(length(origin - point.position), 3e-5F + 1e-4F * (scale + distance));
      const Vec3f away = frame.world_from_local(sample_cosine_hemisphere(s.next_2d()));
      ASSERT_FALSE(tracer.occluded({origin, away, 0, kInfinity, 0})) << scale << ", " << distance << ", " << plane;
      ASSERT_FALSE(tracer.occluded_between(origin, eye, 0)) << scale << ", " << distance << ", " << plane;
      ASSERT_FALSE(tracer.occluded_between(eye, origin, 0)) << scale << ", " << distance << ", " << plane;
    }
  }
}

TEST(OffsetPoint, NeverMeetsItsOwnSurface) {
  for (const float scale : {0.01F, 1.0F, 1000.0F}) expect_no_self_intersection(scale, scale);
}

TEST(OffsetPoint, NeverMeetsItsOwnSurfaceNearTheOrigin) {
  // Where coordinates are small but the surface and the light are not.
  for (const float scale : {0.01F, 1.0F}) {
    expect_no_self_intersection(scale, 0);
    expect_no_self_intersection(scale, 0.01F * scale);
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
      const Vec3f origin = offset_point(p, {1, 0, 0});
      EXPECT_FALSE(tracer.occluded_between(light, origin, 0)) << p.y << ", " << p.z;
      EXPECT_FALSE(tracer.occluded_between(origin, light, 0)) << p.y << ", " << p.z;
    }
  }
}

}  // namespace
}  // namespace chiaro::renderer
