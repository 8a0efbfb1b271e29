#include "inverse/transport/allowed_places.h"

#include <gtest/gtest.h>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/error.h"
#include "renderer/core/sampler.h"
#include "renderer/trace/ray_tracer.h"
#include "tests/support/code_scenes.h"
#include "tests/support/distance_to_surfaces.h"

namespace chiaro::inverse {
namespace {

using Eigen::Vector3d;
using renderer::Box3f;
using renderer::Vec3f;
using test::distance_to_surfaces;

class Places : public testing::Test {
 protected:
  // Anywhere in the scene, and around it.
  Vector3d random_position(std::uint32_t k) const {
    renderer::Sampler sampler(5, 0, k);
    const renderer::Vec2f xy = sampler.next_2d();
    const Vec3f part{1.4F * xy.x - 0.2F, 1.4F * xy.y - 0.2F, 1.4F * sampler.next_1d() - 0.2F};
    return to_eigen(bounds_.min + part * bounds_.extent());
  }

  const renderer::Scene scene_ = test::corner_with_ball();
  const Box3f bounds_ = renderer::RayTracer(scene_).bounds();
};

TEST_F(Places, OfBoxesAreTheNearestInAny) {
  const Box3f a{{0.5F, 0.5F, 0.5F}, {1, 1, 1}}, b{{2, 2, 2}, {3, 2.5F, 3}};
  const AllowedPlaces places(scene_, bounds_, {.boxes = {a, b}});
  EXPECT_EQ(*places.nearest({0, 0.7, 2}), Vector3d(0.5, 0.7, 1));
  EXPECT_EQ(*places.nearest({2.5, 2.6, 4}), Vector3d(2.5, 2.5, 3));
  EXPECT_TRUE(places.contains({0.75, 0.75, 0.75}));
  EXPECT_FALSE(places.contains({1.5, 1.5, 1.5}));
}

TEST_F(Places, KeepTheirDistanceFromSurfaces) {
  const double distance = 0.4;
  const AllowedPlaces places(scene_, bounds_, {.surface_distance = distance});
  int moved = 0;
  for (std::uint32_t k = 0; k < 500; ++k) {
    const Vector3d anywhere = random_position(k);
    const auto place = places.nearest(anywhere);
    ASSERT_TRUE(place) << k;
    EXPECT_GE(distance_to_surfaces(scene_, *place), distance * (1 - 1e-6)) << k;
    EXPECT_TRUE(bounds_.contains(to_vec3f(*place))) << k;
    if (distance_to_surfaces(scene_, anywhere) >= distance && bounds_.contains(to_vec3f(anywhere))) {
      EXPECT_LT((*place - anywhere).norm(), 1e-5) << k;
    } else {
      ++moved;
    }
  }
  EXPECT_GT(moved, 100);
}

// Distances of the size of what floats can say: none is undercut by a light as it is given out.
TEST_F(Places, KeepSmallDistancesInFloats) {
  for (const double distance : {4.1217881e-3, 1e-4, 1e-6}) {
    const AllowedPlaces places(scene_, bounds_, {.surface_distance = distance});
    int found = 0;
    for (std::uint32_t k = 0; k < 300; ++k) {
      Vector3d beside = random_position(k);
      beside[k % 3] = double(bounds_.min[int(k % 3)]);
      const auto place = places.nearest(beside);
      if (!place) continue;  // where ball and floor meet
      ++found;
      const Vector3d given = to_eigen(to_vec3f(*place));
      EXPECT_EQ(given, *place) << k;
      EXPECT_GE(distance_to_surfaces(scene_, given), distance * (1 - 1e-12)) << k;
    }
    EXPECT_GE(found, 280) << distance;
  }
}

TEST_F(Places, HangInFrontOfANode) {
  const std::string node = scene_.instances.back().name;
  ASSERT_FALSE(node.empty());
  const AllowedPlaces places(scene_, bounds_, {.mounts = {{node, 0.15}}});
  for (std::uint32_t k = 0; k < 200; ++k) {
    const auto place = places.nearest(random_position(k));
    ASSERT_TRUE(place) << k;
    EXPECT_NEAR(distance_to_surfaces(scene_, *place, node), 0.15, 2e-4) << k;
  }
}

// A floor ends at its rim, and a ball nowhere.
TEST_F(Places, HangOnSurfacesNotBesideTheirRims) {
  renderer::Scene scene;
  test::add_mesh(scene, test::rectangle({0, 0, 0}, {0, 0, 2}, {2, 0, 0}, 3), test::lambert({1, 1, 1}), "floor");
  test::add_mesh(scene, test::rectangle({0, 3, 0}, {2, 0, 0}, {0, 0, 2}), test::lambert({1, 1, 1}), "ceiling");
  const Box3f bounds = renderer::RayTracer(scene).bounds();
  const AllowedPlaces places(scene, bounds, {.mounts = {{"floor", 0.15}}});
  int from_beside = 0;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const Vector3d from = random_position(k) - Vector3d(1, 1, 1);
    const auto place = places.nearest(from);
    ASSERT_TRUE(place) << k;
    EXPECT_NEAR(place->y(), 0.15, 2e-4) << k;
    EXPECT_GE(std::min(place->x(), place->z()), -2e-4) << k;
    EXPECT_LE(std::max(place->x(), place->z()), 2 + 2e-4) << k;
    from_beside += std::min(from.x(), from.z()) < 0 || std::max(from.x(), from.z()) > 2;
  }
  EXPECT_GT(from_beside, 100);
  EXPECT_TRUE(places.contains({2, 0.15, 1}));
  EXPECT_FALSE(places.contains({2 + 0.15 * std::sin(0.9), 0.15 * std::cos(0.9), 1}));

  const AllowedPlaces around(scene_, bounds_, {.mounts = {{scene_.instances.back().name, 0.15}}});
  const Vector3d middle = to_eigen(renderer::bounds_of_node(scene_, scene_.instances.back().name).center());
  for (std::uint32_t k = 0; k < 100; ++k) {
    const Vector3d from = random_position(k), place = *around.nearest(from);
    EXPECT_GT((place - middle).normalized().dot((from - middle).normalized()), 0.99) << k;
  }
}

// As near as surfaces allow, which floats must not undercut.
TEST_F(Places, HangAtTheVeryDistanceThatSurfacesAskFor) {
  for (const float height : {2.5F, 3.0F, 4.0F}) {
    renderer::Scene scene;
    test::add_mesh(scene, test::rectangle({0, height, 0}, {2, 0, 0}, {0, 0, 2}), test::lambert({1, 1, 1}), "ceiling");
    for (const double distance : {0.1, 0.2, 0.3, 0.5}) {
      const Box3f bounds{{0, 0, 0}, {2, height, 2}};
      const AllowedPlaces places(scene, bounds, {.mounts = {{"ceiling", distance}}, .surface_distance = distance});
      const auto place = places.nearest({1, 1, 1});
      ASSERT_TRUE(place) << height << ", " << distance;
      EXPECT_NEAR(double(height) - place->y(), distance, 1e-5);
    }
  }
}

// Where one of several regions is too near to surfaces the others are left.
TEST_F(Places, OnSurfacesThatAreTooNearCountForNothing) {
  const std::string node = scene_.instances.back().name;
  const Box3f box{{3, 2, 3}, {3.5F, 2.5F, 3.5F}};
  const AllowedPlaces places(scene_, bounds_, {.boxes = {box}, .mounts = {{node, 0.1}}, .surface_distance = 0.2});
  for (std::uint32_t k = 0; k < 50; ++k) {
    const auto place = places.nearest(random_position(k));
    ASSERT_TRUE(place) << k;
    EXPECT_TRUE(box.contains(to_vec3f(*place))) << k;
  }
}

TEST_F(Places, SettleLightsFarApart) {
  const AllowedPlaces places(scene_, bounds_, {.surface_distance = 0.2, .light_distance = 0.5},
                             {to_eigen(bounds_.center())});
  const auto expect_far_apart = [&](const std::vector<Vector3d>& lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
      EXPECT_GE((lights[i] - to_eigen(bounds_.center())).norm(), 0.5 - 1e-6);
      EXPECT_GE(distance_to_surfaces(scene_, lights[i]), 0.2 * (1 - 1e-6));
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE((lights[i] - lights[j]).norm(), 0.5 - 1e-6);
    }
  };
  int settled = 0;
  for (std::uint32_t k = 0; k < 100; ++k) {
    std::vector<Vector3d> lights;
    for (std::uint32_t j = 0; j < 5; ++j) lights.push_back(0.3 * random_position(5 * k + j));
    if (!places.settle(lights)) continue;
    ++settled;
    expect_far_apart(lights);
  }
  EXPECT_GT(settled, 50);
  std::vector<Vector3d> same(3, to_eigen(bounds_.center()) + Vector3d(0.8, 0.1, 0));
  ASSERT_TRUE(places.settle(same));
  expect_far_apart(same);
}

TEST_F(Places, ThatDoNotExistAreToldSo) {
  const AllowedPlaces none(scene_, bounds_, {.surface_distance = 100});
  EXPECT_FALSE(none.nearest(to_eigen(bounds_.center())));
  const AllowedPlaces small(scene_, {{1, 1, 1}, {1.1F, 1.1F, 1.1F}}, {.light_distance = 1});
  std::vector<Vector3d> two{{1, 1, 1}, {1.1, 1.1, 1.1}};
  EXPECT_FALSE(small.settle(two));
  EXPECT_THROW(AllowedPlaces(scene_, bounds_, {.mounts = {{"no such node", 0}}}), renderer::Error);
  try {
    AllowedPlaces(scene_, bounds_, {.mounts = {{"no such node", 0, {"limits.json", "regions[2]"}}}});
    ADD_FAILURE() << "no error";
  } catch (const renderer::Error& error) {
    EXPECT_EQ(error.parts().file + ": " + error.parts().place, "limits.json: regions[2]");
  }
  EXPECT_THROW(AllowedPlaces(scene_, bounds_, {.boxes = {{{90, 90, 90}, {91, 91, 91}}}}), renderer::Error);
  const std::string node = scene_.instances.back().name;
  EXPECT_THROW(AllowedPlaces(scene_, bounds_, {.mounts = {{node, 0.1}}, .surface_distance = 0.2}), renderer::Error);
}

}  // namespace
}  // namespace chiaro::inverse
