// The stages of a solve on targets of known lights, direct light only, where the truth is exact.

#include <gtest/gtest.h>

#include "inverse/solve/choose_light_count.h"
#include "inverse/solve/insertion.h"
#include "inverse/solve/light_clusters.h"
#include "inverse/solve/light_distribution.h"
#include "inverse/solve/optimize_simplex.h"
#include "inverse/solve/pair_of_lights.h"
#include "inverse/solve/refine_joint.h"
#include "inverse/solve/settle_positions.h"
#include "inverse/solve/split_lights.h"
#include "inverse/transport/eigen_vectors.h"
#include "renderer/core/sampler.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;
using tests::DirectProblem;
using tests::farthest_from;
using tests::known_lights;

double spacing_of(const DirectProblem& problem) { return double(max_component(problem.response().grid().spacing)); }

double contribution(const DirectProblem& problem, const LightEstimate& light) {
  const Column column = problem.response().evaluate(light.position, Evaluation::kTracedVisibility);
  return contribution_norm(problem.observations(), column, light.intensity);
}

LightTree tree_of(const DirectProblem& problem) {
  const LightDistribution distribution = estimate_light_distribution(problem.response(), problem.observations(), 0.02);
  return make_light_tree(problem.response(), problem.observations(),
                         segment_distribution(distribution, problem.observations()));
}

// Inside the ball, where they light nothing.
TEST(LightClusters, ThatContributeNothingMergeHalfWay) {
  const tests::DirectProblem problem(tests::known_lights(1));
  const LightEstimates hidden{{{2.1, 0.6, 1.8}, {1, 1, 1}}, {{2.3, 0.6, 1.8}, {1, 1, 1}}};
  const LightTree tree = make_light_tree(problem.response(), problem.observations(), hidden);
  ASSERT_EQ(tree.representatives.size(), 3U);
  EXPECT_LT((tree.representatives[2].position - Eigen::Vector3d(2.2, 0.6, 1.8)).norm(), 1e-9);
}

TEST(LightDistribution, GathersAroundTheLights) {
  for (const std::size_t count : {1U, 2U}) {
    const DirectProblem problem(known_lights(count));
    const LightDistribution distribution =
        estimate_light_distribution(problem.response(), problem.observations(), 0.02);
    double near = 0, all = 0;
    for (const LightEstimate& light : distribution.rounds[1].lights) {
      double nearest = 1e30;
      for (const LightEstimate& known : known_lights(count)) {
        nearest = std::min(nearest, (known.position - light.position).norm());
      }
      const double c = contribution(problem, light);
      all += c, near += nearest < 1.5 * spacing_of(problem) ? c : 0;
    }
    EXPECT_GT(near, 0.8 * all) << count;
    const DistributionRound& fine = distribution.rounds[1];
    EXPECT_LT(fine.relative_error, 0.2);
    for (const DistributionRound& round : distribution.rounds) {
      EXPECT_GT(round.kept, 0U);
      EXPECT_LE(round.kept, round.lit);
      EXPECT_LE(round.lit, round.spread);
      EXPECT_LE(round.kkt_residual, 1e-6);
    }
    EXPECT_EQ(distribution.nodes.size(), fine.lights.size());
    EXPECT_EQ(distribution.columns.size(), fine.lights.size());
  }
}

TEST(LightClusters, OneLightIsOneClusterNearIt) {
  const LightEstimates known = known_lights(1);
  const DirectProblem problem(known);
  const LightDistribution distribution = estimate_light_distribution(problem.response(), problem.observations(), 0.02);
  const LightEstimates clusters = segment_distribution(distribution, problem.observations());
  ASSERT_FALSE(clusters.empty());
  std::size_t strongest = 0;
  double all = 0;
  for (std::size_t j = 0; j < clusters.size(); ++j) {
    all += contribution(problem, clusters[j]);
    if (contribution(problem, clusters[j]) > contribution(problem, clusters[strongest])) strongest = j;
  }
  EXPECT_LT((clusters[strongest].position - known[0].position).norm(), spacing_of(problem));
  EXPECT_GT(contribution(problem, clusters[strongest]), 0.7 * all);
}

TEST(LightClusters, TreesMergeContributionsAndIntensities) {
  const DirectProblem problem(known_lights(3));
  const LightTree tree = tree_of(problem);
  ASSERT_GT(tree.tree.leaf_count, 2);
  EXPECT_EQ(tree.representatives.size(), tree.tree.nodes.size());
  EXPECT_EQ(tree.columns.size(), tree.tree.nodes.size());
  for (std::size_t n = 0; n < tree.tree.nodes.size(); ++n) {
    const auto& node = tree.tree.nodes[n];
    if (node.left < 0) continue;
    const LightEstimate& a = tree.representatives[std::size_t(node.left)];
    const LightEstimate& b = tree.representatives[std::size_t(node.right)];
    const LightEstimate& merged = tree.representatives[n];
    EXPECT_LT((merged.intensity - a.intensity - b.intensity).abs().maxCoeff(), 1e-9);  // (3.8)
    // (3.7): between its children.
    const double whole = (a.position - b.position).norm();
    EXPECT_NEAR((merged.position - a.position).norm() + (merged.position - b.position).norm(), whole, 1e-6);
  }
}

TEST(LightClusters, LargerCutsAreAskedForBySizeOrError) {
  const DirectProblem problem(known_lights(3));
  const LightTree tree = tree_of(problem);
  EXPECT_EQ(cut_light_tree(tree, problem.observations(), {0, 2, 2}).lights.size(), 2U);
  EXPECT_EQ(cut_light_tree(tree, problem.observations(), {1e9, 1, 100}).lights.size(), 1U);
  const LightCutResult all = cut_light_tree(tree, problem.observations(), {0, 1, 1000});
  EXPECT_EQ(all.error_curve.size(), all.lights.size());
  EXPECT_NEAR(all.error_curve.back(), all.error, 1e-12);
}

TEST(RefineJoint, RecoversPerturbedLightsExactly) {
  const LightEstimates known = known_lights(2);
  const DirectProblem problem(known);
  LightEstimates start = known;
  start[0].position += Vector3d(0.08, -0.06, 0.05);
  start[1].position += Vector3d(-0.05, 0.07, 0.06);
  start[0].intensity *= 1.3;
  start[1].intensity *= Array3d(0.7, 1.2, 1);
  JointRefinementOptions options;
  options.max_iterations = 200;
  options.function_tolerance = 1e-12;
  const JointRefinement refined = refine_joint(problem.response(), problem.observations(), start, options);
  ASSERT_EQ(refined.lights.size(), 2U);
  EXPECT_LT(refined.error, 1e-4);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_LT((refined.lights[j].position - known[j].position).norm(), 1e-3) << j;
    EXPECT_LT((refined.lights[j].intensity - known[j].intensity).abs().maxCoeff(), 1e-2) << j;
  }
}

TEST(RefineJoint, NeverGetsWorseAndStaysInBounds) {
  const DirectProblem problem(known_lights(3));
  const Box3f region = problem.response().grid().region;
  const std::vector<LightEstimates> starts{{{{0.3, 2.8, 0.3}, {1, 1, 1}}},
                                           {{{3.9, 0.2, 3.9}, {50, 0, 0}}, {{2, 2, 2}, {1, 1, 1}}}};
  for (const LightEstimates& start : starts) {
    const auto columns = evaluate_columns(problem.response(), start, Evaluation::kTracedVisibility);
    const double before = relative_error(problem.observations(),
                                         total_illumination(columns, start, problem.observations().wanted.rows()));
    const JointRefinement refined = refine_joint(problem.response(), problem.observations(), start);
    EXPECT_LE(refined.error, before);
    for (const LightEstimate& light : refined.lights) {
      EXPECT_GE(light.intensity.minCoeff(), 0);
      const Eigen::Vector3f p = light.position.cast<float>();
      for (int a = 0; a < 3; ++a) {
        EXPECT_GE(p[a], region.min[a] - 1e-4F);
        EXPECT_LE(p[a], region.max[a] + 1e-4F);
      }
    }
  }
}

// Tolerances of the descent are in nobody's units.
TEST(RefineJoint, DescendsAsFarUnderDimLightAsUnderBright) {
  LightEstimates known = known_lights(2);
  std::vector<JointRefinement> refined;
  for (const double brightness : {1.0, 1e-9, 1e9}) {
    LightEstimates lights = known;
    for (LightEstimate& light : lights) light.intensity *= brightness;
    const DirectProblem problem(lights);
    LightEstimates start = lights;
    start[0].position += Vector3d(0.08, -0.06, 0.05);
    start[1].position += Vector3d(-0.05, 0.07, 0.06);
    refined.push_back(refine_joint(problem.response(), problem.observations(), start));
  }
  for (const JointRefinement& one : refined) {
    EXPECT_EQ(one.iterations, refined[0].iterations);
    EXPECT_NEAR(one.error, refined[0].error, 1e-3 * refined[0].error);
    for (std::size_t j = 0; j < known.size(); ++j) {
      EXPECT_LT((one.lights[j].position - refined[0].lights[j].position).norm(), 1e-4) << j;
    }
  }
}

TEST(RefineJoint, OfNoLightsIsTheErrorOfDarkness) {
  const DirectProblem problem(known_lights(1));
  EXPECT_NEAR(refine_joint(problem.response(), problem.observations(), {}).error, 1, 1e-12);
}

TEST(OptimizeSimplex, LowersTheErrorAndKeepsTheBounds) {
  const LightEstimates known = known_lights(1);
  const DirectProblem problem(known, 150);
  LightEstimates start = known;
  start[0].position += Vector3d(0.15, -0.1, 0.1);
  start[0].intensity *= 0.8;
  const SimplexOptimum optimum = optimize_simplex(problem.response(), problem.observations(), start);
  ASSERT_EQ(optimum.lights.size(), 1U);
  EXPECT_LT(optimum.error, 0.02);
  EXPECT_LT((optimum.lights[0].position - known[0].position).norm(), 0.02 * problem.diagonal());
  EXPECT_GE(optimum.lights[0].intensity.minCoeff(), 0);
  EXPECT_GT(optimum.evaluations, 20);
}

TEST(SettlePositions, GoesOnWhereDescentStopsAndIsNeverWorse) {
  const LightEstimates known = known_lights(2);
  const DirectProblem problem(known);
  LightEstimates start = known;
  for (LightEstimate& light : start) light.position += Vector3d(0.02, -0.015, 0.02);
  const double before =
      relative_error(problem.observations(),
                     total_illumination(evaluate_columns(problem.response(), start, Evaluation::kTracedVisibility),
                                        start, problem.observations().wanted.rows()));
  const SettledLights settled =
      settle_positions(problem.response(), problem.observations(), start, 0.003 * problem.diagonal());
  EXPECT_LT(settled.error, 0.1 * before);
  EXPECT_LT(farthest_from(known, positions_of(settled.lights)), 0.01);
  EXPECT_GT(settled.evaluations, 0);
  const SettledLights again = settle_positions(problem.response(), problem.observations(), known, 0.05);
  EXPECT_LE(again.error, 1e-6);
  EXPECT_LE(farthest_from(known, positions_of(again.lights)), 1e-6);
}

TEST(SettlePositions, EndsWhenItIsToldTo) {
  const LightEstimates known = known_lights(2);
  const DirectProblem problem(known);
  int asked = 0;
  const SettledLights settled =
      settle_positions(problem.response(), problem.observations(), known, 0.05, [&] { return ++asked > 10; });
  EXPECT_LT(settled.evaluations, 60);
  EXPECT_EQ(settle_positions(problem.response(), problem.observations(), known, 0.05, [] { return true; }).evaluations,
            0);
}

TEST(Insertion, FitsTheIntensityThatExplainsMost) {
  const LightEstimates known = known_lights(1);
  const DirectProblem problem(known);
  LightEstimate light{known[0].position, Array3d::Zero()};
  const Column column = problem.response().direct(light.position);
  const double explained = fit_intensity(problem.observations(), column, light);
  EXPECT_TRUE(light.intensity.isApprox(known[0].intensity, 1e-9)) << light.intensity.transpose();
  const double all = (problem.observations().sqrt_weight.asDiagonal() * problem.observations().wanted).squaredNorm();
  EXPECT_NEAR(explained, all, 1e-9 * all);
}

TEST(Insertion, ProposesTheLightThatIsMissing) {
  const LightEstimates known = known_lights(2);
  const DirectProblem problem(known);
  const LightEstimates proposed = propose_insertions(problem.response(), problem.observations(), {known[0]});
  ASSERT_FALSE(proposed.empty());
  // The best is the first; a cell's diagonal away at most.
  EXPECT_LT((proposed.front().position - known[1].position).norm(), 1.8 * spacing_of(problem));
}

// Lit is the floor of a shaft alone, whose walls look outwards, and hide the light from others right behind them, which
// would be bright without them.
TEST(Insertion, ProposesALightThatWallsHideFromMostReceivers) {
  renderer::Scene scene;
  const auto add_walls = [&](renderer::Vec3f corner, renderer::Vec3f size, int n, bool outwards) {
    renderer::Mesh walls = test::room(size, n);
    for (renderer::Vec3f& p : walls.positions) p += corner;
    for (renderer::Vec3f& normal : walls.normals) normal = outwards ? -normal : normal;
    if (outwards) {
      for (renderer::Triangle& t : walls.triangles) std::swap(t[1], t[2]);
    }
    test::add_mesh(scene, std::move(walls), test::lambert({0.5F, 0.5F, 0.5F}), "walls");
  };
  add_walls({0, 0, 0}, {6, 5, 6}, 1, false);
  add_walls({2.8F, 1, 2.8F}, {0.4F, 1.4F, 0.4F}, 1, true);
  add_walls({2.79F, 0.99F, 2.79F}, {0.42F, 1.42F, 0.42F}, 24, false);
  test::add_mesh(scene, test::rectangle({2.85F, 1.01F, 2.85F}, {0, 0, 0.3F}, {0.3F, 0, 0}, 6),
                 test::lambert({0.5F, 0.5F, 0.5F}), "floor");
  const LightEstimates known{{{3, 1.5, 3}, {3, 2, 1}}};
  const DirectProblem problem(known, 3000, scene);
  const LightEstimates proposed = propose_insertions(problem.response(), problem.observations(), {});
  ASSERT_FALSE(proposed.empty());
  EXPECT_LT((proposed.front().position - known[0].position).norm(), 0.1);
}

TEST(SplitLights, PartsTwoLightsThatWereSeenAsOne) {
  const LightEstimates known{{{1.7, 1.5, 2}, {20, 12, 8}}, {{2.3, 1.6, 2.1}, {10, 18, 20}}};
  const DirectProblem problem(known);
  const JointRefinement one =
      refine_joint(problem.response(), problem.observations(), {{{2, 1.5, 2}, Array3d::Ones()}});
  const auto splits = propose_splits(problem.response(), problem.observations(), one.lights, 5);
  ASSERT_EQ(splits.size(), 1U);
  ASSERT_EQ(splits[0].lights.size(), 2U);
  const auto columns = evaluate_columns(problem.response(), splits[0].lights, Evaluation::kTracedVisibility);
  EXPECT_LT(relative_error(problem.observations(),
                           total_illumination(columns, splits[0].lights, problem.observations().wanted.rows())),
            0.8 * one.error);
  const JointRefinement two = refine_joint(problem.response(), problem.observations(), splits[0].lights);
  EXPECT_LT(farthest_from(known, positions_of(two.lights)), 0.01);
}

TEST(SplitLights, LeavesTheBrighterWhereItStands) {
  const LightEstimates known{{{1.7, 1.5, 2}, {40, 30, 50}}, {{2.1, 1.8, 2.3}, {5, 8, 4}}};
  const DirectProblem problem(known);
  const JointRefinement one =
      refine_joint(problem.response(), problem.observations(), {{{1.7, 1.5, 2}, Array3d::Ones()}});
  const auto splits = propose_splits(problem.response(), problem.observations(), one.lights, 1);
  ASSERT_EQ(splits.size(), 1U);
  EXPECT_EQ(splits[0].lights[0].position, one.lights[0].position);
  EXPECT_GT(splits[0].lights[0].intensity.sum(), splits[0].lights[1].intensity.sum());
  const JointRefinement two = refine_joint(problem.response(), problem.observations(), splits[0].lights);
  EXPECT_LT(farthest_from(known, positions_of(two.lights)), 0.01 * problem.diagonal());
}

// What is left of them may ask for nothing clearly, but each channel would have the one that stands for both go
// elsewhere.
TEST(SplitLights, PartsLightsOfDifferentColorsAlongTheLineBetweenThem) {
  constexpr int kPairs = 60;
  int along = 0;
  for (int pair = 0; pair < kPairs; ++pair) {
    renderer::Sampler sampler(std::uint64_t(pair), 0, 0);
    const auto somewhere = [&] { return to_eigen(random_position({{0.8F, 1.6F, 0.8F}, {3.2F, 2.6F, 3.2F}}, sampler)); };
    const Vector3d middle = somewhere();
    const Vector3d half = 0.4 * (somewhere() - somewhere()).normalized();
    const LightEstimates known{{middle + half, {12, 3, 2}}, {middle - half, {2, 4, 14}}};
    const DirectProblem problem(known);
    const JointRefinement one = refine_joint(problem.response(), problem.observations(), {{middle, Array3d::Ones()}});
    const auto splits = propose_splits(problem.response(), problem.observations(), one.lights, 1);
    const Vector3d apart = splits[0].lights[0].position - splits[0].lights[1].position;
    along += std::abs(apart.normalized().dot(half.normalized())) > 0.9 ? 1 : 0;
  }
  EXPECT_GE(along, 55);
}

TEST(SplitLights, TriesTheLightThatStandsForTwoFirst) {
  const LightEstimates known{
      {{1.7, 1.5, 2}, {20, 12, 8}}, {{2.3, 1.6, 2.1}, {10, 18, 20}}, {{3.3, 2.4, 0.6}, {9, 9, 9}}};
  const DirectProblem problem(known);
  const JointRefinement merged = refine_joint(problem.response(), problem.observations(),
                                              {{known[2].position, Array3d::Ones()}, {{2, 1.5, 2}, Array3d::Ones()}});
  const auto splits = propose_splits(problem.response(), problem.observations(), merged.lights, 1);
  ASSERT_EQ(splits.size(), 1U);
  EXPECT_EQ(splits[0].parted, 1U);
  EXPECT_LT((splits[0].lights[0].position - merged.lights[0].position).norm(), 1e-12);
}

TEST(ProposePairs, TakeTwoLightsFarApartForTheOneThatTheyPassedFor) {
  const LightEstimates known{
      {{1.0, 1.5, 1.2}, {12, 4, 6}}, {{2.4, 1.7, 2.4}, {8, 9, 12}}, {{3.3, 2.4, 0.6}, {9, 9, 9}}};
  const DirectProblem problem(known);
  const JointRefinement merged =
      refine_joint(problem.response(), problem.observations(),
                   {{known[2].position, Array3d::Ones()}, {{1.7, 1.6, 1.8}, Array3d::Ones()}}, {.max_iterations = 15});
  const auto pairs = propose_pairs(problem.response(), problem.observations(), merged.lights, 5);
  ASSERT_EQ(pairs.size(), 2U);
  ASSERT_EQ(pairs[0].size(), 3U);
  EXPECT_LT((pairs[0][0].position - merged.lights[0].position).norm(), 1e-12);
  const auto columns = evaluate_columns(problem.response(), pairs[0], Evaluation::kTracedVisibility);
  EXPECT_LT(relative_error(problem.observations(),
                           total_illumination(columns, pairs[0], problem.observations().wanted.rows())),
            merged.error);
  const JointRefinement three = refine_joint(problem.response(), problem.observations(), pairs[0]);
  EXPECT_LT(farthest_from(known, positions_of(three.lights)), 0.01);
  EXPECT_EQ(propose_pairs(problem.response(), problem.observations(), merged.lights, 1).size(), 1U);
  EXPECT_TRUE(propose_pairs(problem.response(), problem.observations(), {}, 1).empty());
}

class CountedLights : public ::testing::TestWithParam<std::size_t> {};

TEST_P(CountedLights, AreCountedAndFound) {
  const LightEstimates known = known_lights(GetParam());
  const DirectProblem problem(known);
  const LightCountResult result = choose_light_count(problem.response(), problem.observations(), tree_of(problem), {});
  EXPECT_EQ(result.lights.size(), known.size());
  EXPECT_LT(farthest_from(known, positions_of(result.lights)), 0.01 * problem.diagonal());
  EXPECT_LT(result.error, 0.02);
  ASSERT_GE(result.sets.size(), known.size());
  EXPECT_GT(result.refinements, 0);
  EXPECT_FALSE(result.out_of_time);
}

INSTANTIATE_TEST_SUITE_P(OneToThree, CountedLights, ::testing::Values(1U, 2U, 3U),
                         [](const auto& count) { return std::to_string(count.param) + "Lights"; });

TEST(ChooseLightCount, GivesAsManyAsAskedAndNoMoreThanAllowed) {
  const DirectProblem problem(known_lights(3));
  const LightTree tree = tree_of(problem);
  LightCountOptions options;
  options.max_lights = 2;
  EXPECT_LE(choose_light_count(problem.response(), problem.observations(), tree, options).lights.size(), 2U);
  options = {};
  options.exact_lights = 2;
  EXPECT_EQ(choose_light_count(problem.response(), problem.observations(), tree, options).lights.size(), 2U);
  options.exact_lights = 4;  // of which one has nothing to do: whether it goes out is up to rounding
  const LightCountResult four = choose_light_count(problem.response(), problem.observations(), tree, options);
  EXPECT_GE(four.lights.size(), 3U);
  EXPECT_LE(four.lights.size(), 4U);
  EXPECT_LT(farthest_from(known_lights(3), positions_of(four.lights)), 0.01 * problem.diagonal());
  LightEstimates known = known_lights(3);
  known.push_back({{0.6, 2.5, 0.7}, {5, 6, 4}});
  known.push_back({{3.4, 0.7, 1.6}, {3, 2, 4}});
  const DirectProblem five(known);
  EXPECT_EQ(choose_light_count(five.response(), five.observations(), tree_of(five), options).lights.size(), 4U);
  options = {};
  options.seconds_left = 0;
  EXPECT_TRUE(choose_light_count(problem.response(), problem.observations(), tree, options).out_of_time);
}

// Capped weights give up the pool of a lamp beside the wall, which is most of the light.
TEST(ChooseLightCount, OneOfManyIsThatWhichTheObjectiveAsksFor) {
  LightEstimates known = known_lights(3);
  known[0] = {{0.3, 2.0, 1.0}, {9, 7, 5}};
  const DirectProblem problem(known, 500);
  const Observations& judged = problem.observations();
  double least = std::numeric_limits<double>::infinity();
  for (const LightEstimate& one : known) {
    least = std::min(least, refine_joint(problem.response(), judged, {one}).error);
  }
  const auto error_by = [&](const Observations* objective) {
    LightCountOptions options;
    options.exact_lights = 1;
    options.judged = objective;
    const LightEstimates one =
        choose_light_count(problem.response(), with_capped_weights(judged), tree_of(problem), options).lights;
    return relative_error(judged, illumination_of(problem.response(), one));
  };
  EXPECT_LT(error_by(&judged), 1.02 * least);
  EXPECT_GT(error_by(nullptr), 1.1 * least);
}

LightEstimates random_lights_of_the_corner(std::size_t count, std::uint32_t seed) {
  LightEstimates lights;
  for (std::uint32_t j = 0; j < count; ++j) {
    renderer::Sampler sampler(seed, 0, j);
    const Vec3f at = random_position({{0.4F, 0.4F, 0.4F}, {3.6F, 2.6F, 3.6F}}, sampler);
    const renderer::Vec2f color = sampler.next_2d();
    lights.push_back({to_eigen(at), {2 + 8 * double(color.x), 2 + 8 * double(color.y), 5}});
  }
  return lights;
}

// Elimination leaves them of all: a search that never sees more lights than it may give ends far from these.
TEST(ChooseLightCount, FewerThanThereAreAreAsGoodAsThoseOfTheWholeSearch) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const DirectProblem problem(random_lights_of_the_corner(5, seed));
    const LightTree tree = tree_of(problem);
    const LightCountResult all = choose_light_count(problem.response(), problem.observations(), tree, {});
    ASSERT_GE(all.sets.size(), 4U);
    for (int count = 1; count < 4; ++count) {
      const LightEstimates& best = all.sets[std::size_t(count) - 1];
      const double error = relative_error(problem.observations(), illumination_of(problem.response(), best));
      LightCountOptions exactly, at_most;
      exactly.exact_lights = at_most.max_lights = count;
      for (const LightCountOptions& options : {exactly, at_most}) {
        const LightCountResult few = choose_light_count(problem.response(), problem.observations(), tree, options);
        EXPECT_EQ(few.lights.size(), std::size_t(count));
        EXPECT_EQ(few.sets.size(), std::size_t(count));
        EXPECT_LT(few.error, 1.1 * error) << count << " of seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace chiaro::inverse
