#include "inverse/transport/receivers.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "inverse/transport/direct_light.h"
#include "renderer/core/error.h"
#include "renderer/io/load_gltf.h"
#include "tests/support/code_scenes.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::Scene;

Scene own_scene(const std::string& name) {
  return renderer::load_gltf(std::filesystem::path(CHIARO_SOURCE_DIR) / "scenes" / name).scene;
}

std::size_t vertices_that_triangles_use(const Scene& scene) {
  std::size_t count = 0;
  for (const renderer::Instance& instance : scene.instances) {
    const renderer::Mesh& mesh = scene.meshes[instance.mesh];
    std::vector<bool> used(mesh.positions.size());
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t v : t) used[v] = true;
    }
    count += std::size_t(std::count(used.begin(), used.end(), true));
  }
  return count;
}

TEST(Receivers, AreTwentyToFiftyThousandByDefault) {
  for (const char* name : {"fiveballs.glb", "cornell.glb"}) {
    const Scene scene = own_scene(name);
    const Receivers receivers = make_receivers(scene, {});
    EXPECT_GE(receivers.size(), 20000U) << name;
    EXPECT_LE(receivers.size(), 50000U) << name;
    EXPECT_GE(receivers.size(), vertices_that_triangles_use(scene)) << name;
    EXPECT_EQ(receivers.samples.size(), receivers.size());
    EXPECT_EQ(receivers.normals.size(), receivers.size());
    EXPECT_EQ(receivers.parts.size(), scene.instances.size());
    std::size_t first = 0, triangle = 0;
    for (const Receivers::Part& part : receivers.parts) {
      EXPECT_EQ(part.first_receiver, first);
      EXPECT_EQ(part.first_triangle, triangle);
      first += part.receiver_count, triangle += part.triangle_count;
    }
    EXPECT_EQ(first, receivers.size());
    EXPECT_EQ(triangle, receivers.triangles.size());
  }
}

// Scenes so simple that all their edges are split at once.
std::vector<Scene> simple_scenes() {
  std::vector<Scene> scenes;
  const auto add = [&](renderer::Mesh mesh, const std::string& name) {
    scenes.emplace_back();
    test::add_mesh(scenes.back(), std::move(mesh), test::lambert({1, 1, 1}), name);
  };
  for (const Vec3f size :
       {Vec3f{1, 1, 1}, Vec3f{2, 2, 2}, Vec3f{6, 3, 6}, Vec3f{4, 3, 5}, Vec3f{10, 2.7F, 3}, Vec3f{0.3F, 0.1F, 50}}) {
    add(test::room(size), fmt::format("box {} {} {}", size.x, size.y, size.z));
  }
  add(test::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), "square");
  add(test::rectangle({0, 0, 0}, {30, 0, 0}, {0, 0.02F, 0}), "strip");
  add(test::rectangle({0, 0, 0}, {1, 0, 0}, {1.9F, 0.01F, 0}), "sheared strip");
  add(test::rectangle({1, 2, 3}, {1, 0, 0}, {0, 1e-4F, 1e-4F}, 7), "needles");
  return scenes;
}

TEST(Receivers, AreTwentyToFiftyThousandInTheSimplestScenesToo) {
  for (const Scene& scene : simple_scenes()) {
    const std::size_t count = make_receivers(scene, {}).size();
    EXPECT_GE(count, 20000U) << scene.meshes[0].name;
    EXPECT_LE(count, 50000U) << scene.meshes[0].name;
  }
}

TEST(Receivers, AreTooManyRatherThanTooFewWhereAStepQuadruplesThem) {
  // 4ⁿ⁺¹ + 2 vertices: 16 386 or 65 538.
  Scene octahedron;
  renderer::Mesh mesh;
  mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.normals = mesh.positions;
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  test::add_mesh(octahedron, mesh, test::lambert({1, 1, 1}), "octahedron");
  EXPECT_EQ(make_receivers(octahedron, {}).size(), 65538U);
}

TEST(Receivers, NeverFewerThanTheScenesVerticesAndNoLongEdge) {
  const Scene scene = test::corner_with_ball();
  EXPECT_EQ(make_receivers(scene, {.max_edge = 100}).size(), vertices_that_triangles_use(scene));
  const Receivers fine = make_receivers(scene, {.max_edge = 0.05F});
  for (const auto& t : fine.triangles) {
    for (int k = 0; k < 3; ++k) EXPECT_LE(length(fine.positions[t[k]] - fine.positions[t[(k + 1) % 3]]), 0.05F);
  }
}

TEST(Receivers, InstancesAreFlattenedWithTheirNormals) {
  Scene scene;
  test::add_mesh(scene, test::sphere({0, 0, 0}, 1, 8), test::lambert({1, 1, 1}), "ball");
  scene.instances[0].world_from_object = renderer::make_transform({5, 0, 0}, {0, 0, 0, 1}, {-2, 2, 2});
  scene.instances.push_back({"other", 0, renderer::make_transform({-5, 1, 0}, {0, 0, 0, 1}, {1, 1, 1})});
  const Receivers receivers = make_receivers(scene, {.max_edge = 100});
  ASSERT_EQ(receivers.parts.size(), 2U);
  EXPECT_EQ(receivers.parts[0].name, "ball");
  EXPECT_EQ(receivers.parts[1].name, "other");
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const bool first = i < receivers.parts[0].receiver_count;
    const Vec3f center = first ? Vec3f{5, 0, 0} : Vec3f{-5, 1, 0};
    const Vec3f outward = receivers.positions[i] - center;
    EXPECT_NEAR(length(outward), first ? 2 : 1, 1e-5F);
    EXPECT_GT(dot(receivers.normals[i], normalize(outward)), 0.999F);
  }
}

TEST(Receivers, SamplesLieOnTheSurfaceCloseToTheirVertex) {
  const Scene scene = test::corner_with_ball();
  const RayTracer tracer(scene);
  const Receivers receivers = make_receivers(scene, {.max_edge = 0.3F});
  const float diagonal = bounds(scene).diagonal();
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const renderer::SurfaceSample& s = receivers.samples[i];
    EXPECT_LE(length(s.position - receivers.positions[i]), 3e-5F * diagonal);
    EXPECT_EQ(s.normal, receivers.normals[i]);
    // From a little in front of it, the nearest surface behind is at that very distance.
    const auto hit = tracer.intersect({s.position + 1e-3F * s.normal, -s.normal, 0, 2e-3F, 0});
    ASSERT_TRUE(hit) << i;
    EXPECT_NEAR(hit->distance, 1e-3F, 2e-5F) << i;
  }
  EXPECT_EQ(fraction_on_surface(tracer, receivers), 1);
}

TEST(Receivers, RoundTripThroughAMeshFileKeepsTheFingerprint) {
  const Scene scene = test::corner_with_ball();
  const Receivers receivers = make_receivers(scene, {.max_edge = 0.2F});
  const test::TemporaryFolder folder;
  save_vertex_mesh(mesh_from_receivers(receivers), folder.path() / "receivers.glb", 1);
  const Receivers again = receivers_from_mesh(renderer::load_vertex_mesh(folder.path() / "receivers.glb"));
  EXPECT_EQ(fingerprint(again), fingerprint(receivers));
  ASSERT_EQ(again.parts.size(), receivers.parts.size());
  for (std::size_t i = 0; i < again.parts.size(); ++i) EXPECT_EQ(again.parts[i].name, receivers.parts[i].name);
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again.samples[i].position, receivers.samples[i].position);
  Receivers moved = receivers;
  moved.positions[17].y += 1e-5F;
  EXPECT_NE(fingerprint(moved), fingerprint(receivers));
}

TEST(Receivers, OfAPlaneUnderALightHaveTheClosedForm) {
  Scene scene;
  test::add_mesh(scene, test::rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), test::lambert({1, 1, 1}), "plane");
  const RayTracer tracer(scene);
  const Receivers receivers = make_receivers(scene, {.max_edge = 0.2F});
  ASSERT_GT(receivers.size(), 400U);
  const Vec3f lamp{0.3F, 1.5F, -0.6F};
  const auto lit = trace_illumination(tracer, receivers.samples, {renderer::PointLight{"", lamp, {10, 20, 30}}},
                                      {.samples = 1, .bounces = 0});
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Vec3f d = lamp - receivers.positions[i];
    const double expected = 10 * 1.5 / (M_PI * std::pow(double(length(d)), 3));
    EXPECT_NEAR(lit.value[i].x, expected, 1e-3 * expected);
    EXPECT_NEAR(lit.value[i].z, 3 * expected, 3e-3 * expected);
  }
}

// A tilted plane through the origin, so many metres across, and a light a tenth of that above it.
// A lamp an eighth of a metre above the floor, whose receivers rounding keeps off the surface by as much as
// millimetres.
TEST(Receivers, FarFromTheOriginAreLitWhereTheirSurfaceIs) {
  for (const float away : {0.0F, 1024.0F, 8192.0F}) {
    Scene scene;
    test::add_mesh(scene, test::rectangle({away - 1, 0, away - 1}, {0, 0, 2}, {2, 0, 0}), test::lambert({1, 1, 1}),
                   "floor");
    const RayTracer tracer(scene);
    const Receivers receivers = make_receivers(scene, {.max_edge = 0.5F});
    const renderer::Lights lamp{renderer::PointLight{"", {away, 0.125F, away}, {10, 10, 10}}};
    const auto traced = renderer::trace_illumination(tracer, receivers.samples, lamp, {.samples = 1, .bounces = 0});
    float brightest = 0;
    for (const renderer::Vec3f value : traced.value) brightest = std::max(brightest, value.x);
    const double expected = 10 / (0.125 * 0.125) / M_PI;
    EXPECT_NEAR(brightest / expected, 1, 0.002 + 1e-6 * double(away)) << away;
    float unity = 0;
    for (const auto& at : receivers.samples) {
      unity = std::max(unity, unoccluded_illumination(at, {away, 0.125F, away}));
    }
    EXPECT_NEAR(10 * unity / brightest, 1, 1e-4) << away;
  }
}

TEST(Receivers, NoneIsHiddenByItsOwnPlaneWhateverItsSize) {
  for (const float size : {3e-3F, 9e-3F, 3.0F, 9.0F, 30.0F, 3e3F, 3e4F}) {
    for (const Vec3f tilt : {Vec3f{1, 2, 3}, Vec3f{-3, 1, 0.2F}, Vec3f{0.1F, -1, 0.3F}}) {
      const renderer::Frame3f frame(normalize(tilt));
      const Vec3f u = size * frame.tangent, v = size * frame.bitangent;
      Scene scene;
      test::add_mesh(scene, test::rectangle(-0.45F * u - 0.55F * v, u, v), test::lambert({1, 1, 1}), "plane");
      const RayTracer tracer(scene);
      const Receivers receivers = make_receivers(scene, {.max_edge = size / 50});
      ASSERT_GT(receivers.size(), 2000U);
      const renderer::PointLight light{"", 0.1F * size * frame.normal, Vec3f{1, 1, 1} * (size * size)};
      const auto lit = trace_illumination(tracer, receivers.samples, {light}, {.samples = 1, .bounces = 0});
      const auto dark = std::count(lit.value.begin(), lit.value.end(), Vec3f{});
      EXPECT_EQ(dark, 0) << size << " m across, of " << receivers.size();
    }
  }
}

// A closed room and a light in its middle: none of its receivers lies in a neighbouring wall.
TEST(Receivers, NoneIsHiddenByTheNextWallHoweverFarFromTheOrigin) {
  for (const float far : {0.0F, 1e3F, 1e4F, 3e4F}) {
    Scene scene;
    renderer::Mesh room = test::room({3, 2, 4}, 4);
    for (Vec3f& p : room.positions) p = p + Vec3f{far, -0.7F * far, 0.3F * far};
    test::add_mesh(scene, room, test::lambert({1, 1, 1}), "room");
    const RayTracer tracer(scene);
    const Receivers receivers = make_receivers(scene, {.max_edge = 0.2F});
    const renderer::PointLight light{"", tracer.bounds().center(), {1, 1, 1}};
    const auto lit = trace_illumination(tracer, receivers.samples, {light}, {.samples = 1, .bounces = 0});
    EXPECT_EQ(std::count(lit.value.begin(), lit.value.end(), Vec3f{}), 0) << far << " m, of " << receivers.size();
  }
}

TEST(Receivers, WhereFloatsAreTooFarApartForThemAreRefused) {
  Scene scene;
  renderer::Mesh room = test::room({3, 2, 4}, 4);
  for (Vec3f& p : room.positions) p = p + Vec3f{1e6F, 0, 0};
  test::add_mesh(scene, room, test::lambert({1, 1, 1}), "room");
  EXPECT_THROW(make_receivers(scene, {.max_edge = 0.05F}), renderer::Error);
  EXPECT_THROW(make_receivers(scene, {}), renderer::Error);
  EXPECT_GT(make_receivers(scene, {.max_edge = 0.5F}).size(), 50U);
}

TEST(Receivers, OfAnotherSceneAreToldByTheirPlaces) {
  const Scene scene = test::corner_with_ball(), other = own_scene("cornell.glb");
  const RayTracer tracer(scene), other_tracer(other);
  const Receivers receivers = make_receivers(scene, {.max_edge = 0.2F});
  EXPECT_EQ(fraction_on_surface(tracer, receivers), 1);
  EXPECT_LT(fraction_on_surface(other_tracer, receivers), 0.5);
  EXPECT_LT(fraction_on_surface(tracer, make_receivers(other, {})), 0.5);
}

// Cut-out surfaces are passed where they are cut out, and unlit skies by all rays but a camera's.
TEST(Receivers, OfHolesAndOfUnlitSurfacesLieOnTheScene) {
  Scene scene;
  renderer::Material leaf = test::lambert({1, 1, 1}), sky = leaf;
  leaf.alpha_mode = renderer::AlphaMode::kMask;
  leaf.alpha = 0.4F;
  sky.unlit = true;
  test::add_mesh(scene, test::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), leaf, "card");
  test::add_mesh(scene, test::room({9, 9, 9}), sky, "sky");
  const RayTracer tracer(scene);
  EXPECT_FALSE(tracer.intersect({{0.3F, 0.3F, 0.1F}, {0, 0, -1}, 0, 0.2F}));
  EXPECT_EQ(fraction_on_surface(tracer, make_receivers(scene, {.max_edge = 0.5F})), 1);
}

TEST(Receivers, OfASceneFarFromTheOriginLieOnIt) {
  for (const float far : {1e4F, 1e5F, 1e6F}) {
    Scene scene;
    renderer::Mesh room = test::room({2, 2, 2});
    for (Vec3f& p : room.positions) p = p + Vec3f{far, 0, -far};
    test::add_mesh(scene, room, test::lambert({1, 1, 1}), "room");
    const RayTracer tracer(scene);
    EXPECT_EQ(fraction_on_surface(tracer, make_receivers(scene, {.max_edge = 0.5F})), 1) << far;
    // Of the same room elsewhere they do not.
    for (Vec3f& p : room.positions) p = p + Vec3f{0.3F * far, 0, 0};
    Scene elsewhere;
    test::add_mesh(elsewhere, room, test::lambert({1, 1, 1}), "room");
    EXPECT_EQ(fraction_on_surface(tracer, make_receivers(elsewhere, {.max_edge = 0.5F})), 0) << far;
  }
}

TEST(Receivers, OfNothingOrOfTooMuchAreErrors) {
  EXPECT_THROW(make_receivers({}, {}), renderer::Error);
  EXPECT_THROW(make_receivers(test::corner_with_ball(), {.max_edge = 1e-5F}), renderer::Error);
}

Scene many_instances(renderer::Mesh mesh, std::size_t count) {
  Scene scene;
  test::add_mesh(scene, std::move(mesh), test::lambert({1, 1, 1}), "one of many");
  scene.instances.resize(count, scene.instances[0]);
  return scene;
}

TEST(Receivers, OfMoreInstancesThanMemoryHoldsAreRefusedBeforeTheyAreFlattened) {
  const renderer::Mesh ball = test::sphere({0, 0, 0}, 1, 256);
  const Scene scene = many_instances(ball, 40'000'000 / ball.positions.size());
  const std::string message = test::error_of([&] { make_receivers(scene, {.max_edge = 100}); });
  EXPECT_NE(message.find("the scene's own vertices"), std::string::npos) << message;
  EXPECT_EQ(message.find("--max-edge"), std::string::npos) << message;
}

TEST(Receivers, VerticesThatNoTriangleUsesAreNotCounted) {
  renderer::Mesh mesh = test::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.positions.resize(1'000'000, mesh.positions[0]);
  mesh.normals.resize(1'000'000, mesh.normals[0]);
  EXPECT_EQ(make_receivers(many_instances(mesh, 40), {.max_edge = 100}).size(), 160U);
}

TEST(Receivers, AFileWithoutUsableNormalsGetsThoseOfItsFaces) {
  renderer::VertexMesh mesh;
  mesh.parts.push_back({});
  mesh.parts[0].positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  mesh.parts[0].normals.assign(3, Vec3f{});
  mesh.parts[0].triangles = {{0, 1, 2}};
  for (const Vec3f n : receivers_from_mesh(mesh).normals) EXPECT_EQ(n, (Vec3f{0, 1, 0}));
}

}  // namespace
}  // namespace chiaro::inverse
