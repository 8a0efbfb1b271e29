// Whole solves whose lights must keep to rules.

#include <gtest/gtest.h>

#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/blackbody.h"
#include "renderer/core/error.h"
#include "tests/inverse/solve/painted_corner.h"
#include "tests/support/distance_to_surfaces.h"

namespace chiaro::inverse {
namespace {

using tests::bake_settings;
using tests::known_lights;
using tests::PaintedCorner;

class ConstrainedSolve : public testing::Test {
 protected:
  SolveProblem problem(const Target& target) const {
    SolveProblem problem{corner_.tracer(), target, {}, {}, bake_settings(0), {}};
    problem.grid.counts = {7, 6, 7};
    return problem;
  }
  static SolveOptions options(int exact_lights = 0) {
    SolveOptions options;
    options.important_vertices = 200;
    options.verification_samples = 16;
    options.exact_lights = exact_lights;
    options.max_lights = 4;
    return options;
  }

  const PaintedCorner corner_;
  const Target target_ = corner_.target(known_lights(3), 0);
};

std::vector<renderer::PointLight> lights_of(const SolveResult& result) {
  std::vector<renderer::PointLight> lights;
  for (const FoundLight& found : result.lights) lights.push_back(std::get<renderer::PointLight>(found.light));
  return lights;
}

TEST_F(ConstrainedSolve, LightsKeepTheirDistances) {
  SolveProblem ruled = problem(target_);
  ruled.places = {.surface_distance = 0.9, .light_distance = 1.5};
  const SolveResult result = solve(ruled, options(3));
  const auto lights = lights_of(result);
  ASSERT_EQ(lights.size(), 3U);
  ASSERT_EQ(result.error_curve.size(), 3U);
  for (std::size_t k = 1; k < 3; ++k)
    EXPECT_LE(result.error_curve[k].relative_l2, result.error_curve[k - 1].relative_l2);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    EXPECT_GE(test::distance_to_surfaces(corner_.scene(), to_eigen(lights[i].position)), 0.9 - 1e-6);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(length(lights[i].position - lights[j].position), 1.5F);
  }
}

// Where time is up before any light has been moved, too.
TEST_F(ConstrainedSolve, LightsKeepTheirPlacesWhereTimeIsUp) {
  const Box3f box{{2.6F, 1, 2}, {3.6F, 2.6F, 3.5F}};
  const PlaceRules rules[] = {{.surface_distance = 1.2}, {.light_distance = 2.5}, {.boxes = {box}}};
  for (const PlaceRules& rule : rules) {
    SolveProblem ruled = problem(target_);
    ruled.places = rule;
    SolveOptions hurried = options();
    hurried.time_limit = 1e-9;
    const SolveResult result = solve(ruled, hurried);
    std::vector<std::vector<renderer::PointLight>> sets{lights_of(result)};
    for (const LightSet& set : result.error_curve) sets.push_back(set.lights);
    EXPECT_FALSE(sets.front().empty());
    for (const auto& lights : sets) {
      for (std::size_t i = 0; i < lights.size(); ++i) {
        const Eigen::Vector3d at = to_eigen(lights[i].position);
        EXPECT_GE(test::distance_to_surfaces(corner_.scene(), at), rule.surface_distance - 1e-6);
        for (std::size_t j = 0; j < i; ++j) {
          EXPECT_GE(double(length(lights[i].position - lights[j].position)), rule.light_distance - 1e-5);
        }
        EXPECT_TRUE(rule.boxes.empty() || box.contains(lights[i].position));
      }
    }
  }
}

TEST_F(ConstrainedSolve, LightsStandInOneOfSeveralBoxes) {
  SolveProblem ruled = problem(target_);
  ruled.places.boxes = {{{0.2F, 2, 0.2F}, {1, 2.5F, 3}}, {{2.6F, 1, 2}, {3.6F, 2.6F, 3.5F}}};
  const auto lights = lights_of(solve(ruled, options()));
  ASSERT_FALSE(lights.empty());
  for (const auto& light : lights) {
    EXPECT_TRUE(ruled.places.boxes[0].contains(light.position) || ruled.places.boxes[1].contains(light.position));
  }
}

TEST_F(ConstrainedSolve, NoChannelIsBrighterThanAllowed) {
  SolveProblem ruled = problem(target_);
  ruled.intensities.max_intensity = 4.1;
  const auto lights = lights_of(solve(ruled, options()));
  ASSERT_FALSE(lights.empty());
  for (const auto& light : lights) EXPECT_LE(double(max_component(light.intensity)), 4.1);
}

// Each explains a small part of what is left, and fewer would not do. The lights of the target have 17 cd together in
// the channel that takes most of them.
TEST_F(ConstrainedSolve, ManyDimLightsStandForFewBrightOnes) {
  SolveProblem ruled = problem(target_);
  ruled.intensities.max_intensity = 2;
  SolveOptions many = options();
  many.max_lights = 12;
  const SolveResult result = solve(ruled, many);
  EXPECT_GE(result.lights.size(), 9U);
  EXPECT_LT(result.relative_l2, 0.15);  // 0.25 where each had to explain a fifth
  for (const auto& light : lights_of(result)) EXPECT_LE(double(max_component(light.intensity)), 2);
}

// What the important vertices make of lights close to surfaces may be half of what the whole target does.
TEST_F(ConstrainedSolve, TheCurveTellsTheErrorOfItsSets) {
  SolveProblem ruled = problem(target_);
  ruled.places.boxes = {{{0, 0.05F, 0}, {4, 0.15F, 4}}, {{0, 2.85F, 0}, {4, 2.95F, 4}}};
  ruled.places.surface_distance = 0.05;
  ruled.intensities.max_intensity = 10;
  const SolveResult result = solve(ruled, options());
  ASSERT_GE(result.error_curve.size(), 3U);
  double fewer = 2;
  for (const LightSet& set : result.error_curve) {
    const Target produced = corner_.target(light_estimates(set.lights), 0);
    const double traced = relative_l2(produced.illumination, target_.illumination, target_.weight);
    EXPECT_NEAR(set.relative_l2, traced, 0.05 * traced) << set.lights.size() << " lights";
    EXPECT_LE(set.relative_l2, fewer) << set.lights.size() << " lights";
    fewer = set.relative_l2;
  }
}

TEST_F(ConstrainedSolve, LightsThatMayNotBeSeenAreNoneThatArePossible) {
  for (const int lights : {0, 1, 2}) {
    SolveProblem ruled = problem(target_);
    ruled.intensities.max_intensity = 1e-30;
    try {
      const SolveResult result = solve(ruled, options(lights));
      ADD_FAILURE() << lights << ": " << result.lights.size() << " lights";
    } catch (const renderer::Error& error) {
      EXPECT_NE(std::string(error.what()).find("no light possible"), std::string::npos) << error.what();
    }
  }
}

TEST_F(ConstrainedSolve, AllHaveOneColor) {
  SolveProblem ruled = problem(target_);
  ruled.intensities.one_color = true;
  const auto lights = lights_of(solve(ruled, options(3)));
  ASSERT_EQ(lights.size(), 3U);
  const auto color = [](const renderer::PointLight& l) { return l.intensity / max_component(l.intensity); };
  for (const auto& light : lights) EXPECT_LT(length(color(light) - color(lights[0])), 1e-5F);
}

// Lights that are black bodies, so that the rule does not stand in the way of the truth.
TEST_F(ConstrainedSolve, FindsBlackBodies) {
  LightEstimates known = known_lights(2);
  known[0].intensity = 8 * to_eigen(renderer::blackbody_color(3000)).array();
  known[1].intensity = 6 * to_eigen(renderer::blackbody_color(6000)).array();
  const Target target = corner_.target(known, 0);
  SolveProblem ruled = problem(target);
  ruled.intensities.kelvin = {2500, 7000};
  const SolveResult result = solve(ruled, options(2));
  const auto lights = lights_of(result);
  ASSERT_EQ(lights.size(), 2U);
  EXPECT_LT(result.relative_l2, 0.01);
  for (const auto& light : lights) {
    const bool first = (to_eigen(light.position) - known[0].position).norm() < 0.5;
    const Eigen::Vector3d wanted = known[first ? 0 : 1].intensity.matrix();
    EXPECT_LT((to_eigen(light.intensity) - wanted).norm(), 0.02 * wanted.norm());
  }
}

// The wanted lights are bluer than allowed: the bluest allowed is taken.
TEST_F(ConstrainedSolve, TemperaturesStayInTheirRange) {
  LightEstimates known = known_lights(1);
  known[0].intensity = 8 * to_eigen(renderer::blackbody_color(9000)).array();
  const Target target = corner_.target(known, 0);
  SolveProblem ruled = problem(target);
  ruled.intensities.kelvin = {2700, 4000};
  const auto lights = lights_of(solve(ruled, options(1)));
  ASSERT_EQ(lights.size(), 1U);
  const Vec3f color = lights[0].intensity / max_component(lights[0].intensity);
  EXPECT_LT(length(color - renderer::blackbody_color(4000)), 1e-3F);
}

TEST_F(ConstrainedSolve, LightsInPlaceGetTheirIntensitiesBack) {
  renderer::SpotLight spot;
  spot.name = "Spot";
  spot.position = {1.0F, 2.5F, 1.0F};
  spot.direction = normalize(Vec3f{0.3F, -1, 0.2F});
  spot.outer_cone_angle = 0.9F;
  spot.intensity = {3, 6, 9};
  renderer::PointLight point{"Point", {3, 2, 3}, {5, 4, 2}};
  const renderer::TraceOptions trace{.samples = 256, .bounces = -1, .seed = 99};
  const auto lit = trace_illumination(corner_.tracer(), corner_.receivers().samples, {spot, point}, trace);
  const Target target{corner_.receivers(), lit.value, std::vector<float>(lit.value.size(), 1.0F), {}};
  SolveProblem in_place = problem(target);
  in_place.bake.bounces = -1;
  spot.intensity = point.intensity = {1, 1, 1};
  in_place.lights_in_place = {spot, point};
  const SolveResult result = solve(in_place, options());
  ASSERT_EQ(result.lights.size(), 2U);
  const auto& found = std::get<renderer::SpotLight>(result.lights[0].light);
  EXPECT_EQ(found.position, spot.position);
  EXPECT_LT(length(found.intensity - Vec3f{3, 6, 9}), 0.1F);
  EXPECT_LT(length(std::get<renderer::PointLight>(result.lights[1].light).intensity - Vec3f{5, 4, 2}), 0.1F);
  for (int c = 0; c < 3; ++c) EXPECT_GT(result.lights[0].intensity_interval[c], 0.0F);
}

// Bulbs of a chandelier, and two lamps in one place: what noise tells them apart by is nothing. 90 % of 5 × 3
// intensities in 8 targets, which are 120, whose errors go together: fewer than 90 inside has p < 1 %.
TEST_F(ConstrainedSolve, LampsInPlaceThatAreHardlyToldApartHaveWideIntervals) {
  constexpr std::uint64_t kSeeds = 8;
  renderer::Lights bulbs;
  for (int k = 0; k < 5; ++k) {
    const float angle = 1.2566F * float(k), intensity = 2.0F * float(k + 1);
    const Vec3f at{2 + 0.08F * std::cos(angle), 2, 2 + 0.08F * std::sin(angle)};
    bulbs.push_back(renderer::PointLight{"", at, {intensity, intensity, intensity}});
  }
  int inside = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const renderer::TraceOptions trace{.samples = 64, .bounces = -1, .seed = 1000 + seed};
    const auto lit = trace_illumination(corner_.tracer(), corner_.receivers().samples, bulbs, trace);
    const Target target{corner_.receivers(), lit.value, std::vector<float>(lit.value.size(), 1.0F), {}};
    SolveProblem in_place = problem(target);
    in_place.bake.bounces = -1;
    in_place.lights_in_place = bulbs;
    SolveOptions how = options();
    how.verification_samples = 128;
    how.seed = seed;
    const SolveResult result = solve(in_place, how);
    for (std::size_t j = 0; j < bulbs.size(); ++j) {
      const Vec3f found = std::get<renderer::PointLight>(result.lights[j].light).intensity;
      const Vec3f wanted = std::get<renderer::PointLight>(bulbs[j]).intensity;
      for (int c = 0; c < 3; ++c) {
        inside += std::abs(found[c] - wanted[c]) <= result.lights[j].intensity_interval[c] ? 1 : 0;
      }
    }
  }
  EXPECT_GE(inside, 90);
}

TEST_F(ConstrainedSolve, LampsInOnePlaceAreNotToldApart) {
  const Target target = corner_.target(known_lights(2), -1);
  SolveProblem in_place = problem(target);
  in_place.bake.bounces = -1;
  in_place.lights_in_place = point_lights(known_lights(2));
  in_place.lights_in_place.push_back(in_place.lights_in_place[1]);
  SolveOptions how = options();
  how.verification_samples = 128;
  const SolveResult result = solve(in_place, how);
  EXPECT_EQ(result.not_told_apart, (std::vector<std::pair<int, int>>{{2, 3}}));
  EXPECT_LT(max_component(result.lights[0].intensity_interval),
            0.1F * max_component(std::get<renderer::PointLight>(result.lights[0].light).intensity));
}

// Direct light has no noise, which would make them look unlike each other.
TEST_F(ConstrainedSolve, OfLampsInOnePlaceNoIntensityIsKnown) {
  const Target target = corner_.target(known_lights(2), 0);
  SolveProblem in_place = problem(target);
  in_place.bake.bounces = 0;
  in_place.lights_in_place = point_lights(known_lights(2));
  in_place.lights_in_place.push_back(in_place.lights_in_place[1]);
  const SolveResult result = solve(in_place, options());
  EXPECT_TRUE(is_finite(result.lights[0].intensity_interval));
  EXPECT_TRUE(std::isinf(max_component(result.lights[1].intensity_interval)));
  EXPECT_TRUE(std::isinf(max_component(result.lights[2].intensity_interval)));
  EXPECT_EQ(result.not_told_apart, (std::vector<std::pair<int, int>>{{2, 3}}));
}

// What the lights of the lightcut left before they kept to any rule says nothing of those that do.
TEST_F(ConstrainedSolve, TheLastOptimisationStartsFromLightsThatKeepToTheRules) {
  SolveProblem ruled = problem(target_);
  ruled.intensities.max_intensity = 1;
  const SolveResult result = solve(ruled, options());
  EXPECT_GE(result.initial_relative_l2, 0.99 * result.relative_l2_cached);
}

// One light explains it all.
TEST_F(ConstrainedSolve, AsManyLightsAsAskedForShine) {
  const Target target = corner_.target(known_lights(1), 0);
  for (const SolveMethod method : {SolveMethod::kJoint, SolveMethod::kThesis}) {
    SolveOptions how = options(4);
    how.method = method;
    const SolveResult result = solve(problem(target), how);
    ASSERT_EQ(result.lights.size(), 4U);
    for (const auto& light : lights_of(result)) EXPECT_GT(max_component(light.intensity), 0.0F);
    EXPECT_LT(result.relative_l2, 0.2);
  }
}

TEST_F(ConstrainedSolve, LightsFarApartAreFoundWhereFewerExplainAll) {
  const Target target = corner_.target(known_lights(1), 0);
  SolveProblem ruled = problem(target);
  ruled.places.light_distance = 1.8;
  ruled.kept_lights = {renderer::PointLight{"", {0.5F, 2.5F, 0.5F}, {0.1F, 0.1F, 0.1F}}};
  const auto lights = lights_of(solve(ruled, options(4)));
  ASSERT_EQ(lights.size(), 4U);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    EXPECT_GE(length(lights[i].position - Vec3f{0.5F, 2.5F, 0.5F}), 1.8F);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(length(lights[i].position - lights[j].position), 1.8F);
  }
}

std::string error_of(const SolveProblem& ruled, const SolveOptions& how) {
  try {
    solve(ruled, how);
  } catch (const renderer::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(ConstrainedSolve, LightsInPlaceThatBreakARuleAreNamed) {
  SolveProblem ruled = problem(target_);
  renderer::SpotLight spot;
  spot.position = {1, 0.5F, 1};
  ruled.lights_in_place = {renderer::PointLight{"Bulb", {3, 2, 3}, {1, 1, 1}}, spot};
  EXPECT_EQ(error_of(ruled, options()), "no error");
  const auto names = [&](const PlaceRules& rules, const char* text) {
    ruled.places = rules;
    EXPECT_NE(error_of(ruled, options()).find(text), std::string::npos) << error_of(ruled, options());
  };
  names({.boxes = {{{0, 0, 0}, {2, 2, 2}}}}, "\"Bulb\" stays where it is, outside all regions");
  names({.surface_distance = 0.6}, "light 2 stays where it is, and that is not 0.6 m from all surfaces");
  names({.light_distance = 4}, "light 2 stays where it is, and is not 4 m apart from \"Bulb\"");
}

TEST_F(ConstrainedSolve, WhatNoLightCanKeepToIsNamed) {
  SolveProblem ruled = problem(target_);
  ruled.places.surface_distance = 50;
  EXPECT_NE(error_of(ruled, options()).find("nowhere in the region is a place 50 m from all surfaces"),
            std::string::npos);
  ruled.places = {.light_distance = 5};
  ruled.grid.region = default_region(corner_.tracer());
  EXPECT_NE(error_of(ruled, options(3)).find("3 lights 5 m apart find no place"), std::string::npos)
      << error_of(ruled, options(3));
}

}  // namespace
}  // namespace chiaro::inverse
