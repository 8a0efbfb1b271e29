#include "inverse/solve/held_out.h"

#include <gtest/gtest.h>

#include "inverse/transport/bake.h"
#include "inverse/transport/eigen_vectors.h"
#include "inverse/transport/receivers.h"
#include "renderer/core/sampler.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

// Of the room's floor and walls, a receiver every few decimetres.
std::vector<renderer::SurfaceSample> receivers_of(const renderer::Scene& scene) {
  return make_receivers(scene, {.max_edge = 0.5F}).samples;
}

Observations observations_of(const Column& target) {
  Observations o;
  o.target = o.wanted = target;
  o.sqrt_weight = o.stands_for = Eigen::VectorXd::Ones(target.rows());
  o.standard_error = Eigen::VectorXd::Zero(target.rows());
  o.measure_target();
  return o;
}

class HeldOutRoom : public ::testing::Test {
 protected:
  HeldOutRoom() {
    test::add_mesh(scene_, test::room({4, 3, 4}, 2), test::lambert({0.6F, 0.5F, 0.4F}), "room");
    tracer_.emplace(scene_);
    receivers_ = receivers_of(scene_);
    const renderer::Lights lights{point_light(lights_[0]), point_light(lights_[1])};
    const auto traced = trace_illumination(*tracer_, receivers_, lights, {512, -1, 9, false}).value;
    Column target(Eigen::Index(traced.size()), 3);
    for (std::size_t i = 0; i < traced.size(); ++i) target.row(Eigen::Index(i)) = to_eigen(traced[i]).transpose();
    observations_ = observations_of(target);
    held_out_.emplace(*tracer_, receivers_, observations_, observations_, settings_);
  }

  // As if no others had been asked for.
  Eigen::VectorXd residuals(const LightEstimates& lights) const { return HeldOutSets(*held_out_, 0).residuals(lights); }

  renderer::Scene scene_;
  std::optional<renderer::RayTracer> tracer_;
  std::vector<renderer::SurfaceSample> receivers_;
  const BakeSettings settings_{.samples = 256, .bounces = -1, .seed = 3, .materials = "gltf"};
  // The second is dim.
  const LightEstimates lights_{{{1.2, 2.1, 1.5}, {10, 8, 6}}, {{3, 1, 2.6}, {0.3, 0.5, 0.7}}};
  Observations observations_;
  std::optional<HeldOut> held_out_;
};

TEST_F(HeldOutRoom, TheRightLightsLeaveLittle) {
  const double target = residuals({}).norm();
  EXPECT_LT(residuals(lights_).norm(), 0.03 * target);
  EXPECT_GT(residuals({lights_[0]}).norm(), 0.05 * target);
}

TEST_F(HeldOutRoom, LeadsLightsToWhereTheyComeClosest) {
  const Receivers receivers = make_receivers(scene_, {.max_edge = 0.5F});
  const LightGrid grid = make_light_grid(*tracer_, {.counts = {3, 3, 3}, .region = {}});
  BakeSettings direct = settings_;
  direct.bounces = 0;
  const TransportCache cache = bake(*tracer_, receivers, grid, direct).cache;
  const LightResponse search(*tracer_, receivers.samples, cache);
  LightEstimates led = lights_;
  for (LightEstimate& light : led) light.position += Eigen::Vector3d(0.1, -0.05, 0.1);
  HeldOutSets sets(*held_out_, 0);
  HeldOutFit fit = sets.refit(led);
  const double before = fit.error;
  for (int k = 0; k < 4 && sets.lead_closer(search, led, fit); ++k) continue;
  LightEstimates right = lights_;
  EXPECT_LE(fit.error, 1.01 * sets.refit(right).error);
  EXPECT_LT(fit.error, 0.3 * before);
  EXPECT_LT((led[0].position - lights_[0].position).norm(), 0.01);
  const LightEstimates at_rest = led;
  const HeldOutFit least = fit;
  fit.error = 0;
  EXPECT_FALSE(sets.lead_closer(search, led, fit));
  EXPECT_EQ(led[0].position, at_rest[0].position);
  EXPECT_EQ(sets.refit(led).error, least.error);
}

TEST_F(HeldOutRoom, ALightThatIsThereIsClearlySeen) {
  const Eigen::VectorXd without = residuals({lights_[0]}), with = residuals(lights_);
  EXPECT_TRUE(clearly_smaller(without, with));
  EXPECT_FALSE(clearly_smaller(with, without));
  EXPECT_FALSE(clearly_smaller(with, with));
}

TEST_F(HeldOutRoom, ALightThatFitsNoiseIsNot) {
  LightEstimates more = lights_;
  more.push_back({{3.8, 2.8, 0.3}, {0.02, 0.02, 0.02}});
  EXPECT_FALSE(clearly_smaller(residuals(lights_), residuals(more)));
}

TEST_F(HeldOutRoom, TellsWhatPartOfTheTargetLightsMiss) {
  EXPECT_NEAR(held_out_->part_missed(residuals({})), 1, 1e-12);
  EXPECT_LT(held_out_->part_missed(residuals(lights_)), 0.01);
  EXPECT_GT(held_out_->part_missed(residuals({lights_[1]})), 0.5);
}

TEST_F(HeldOutRoom, RefitsIntensitiesAndTellsTheErrorOfTheObjectiveAndThePublishedOne) {
  LightEstimates refitted = lights_;
  for (LightEstimate& light : refitted) light.intensity.setOnes();
  HeldOutSets sets(*held_out_, 0);
  const HeldOutFit fit = sets.refit(refitted);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_LT((refitted[j].intensity / lights_[j].intensity - 1).abs().maxCoeff(), j == 0 ? 0.005 : 0.05);
  }
  EXPECT_NEAR(fit.relative_l2, residuals(refitted).norm() / residuals({}).norm(), 1e-6);
  EXPECT_NEAR(fit.error, held_out_->error(residuals(refitted)), 1e-6);
  // An objective that looks at the first half alone.
  Observations half = observations_;
  half.sqrt_weight.tail(half.sqrt_weight.size() / 2).setZero();
  half.measure_target();
  const HeldOut by_half(*tracer_, receivers_, observations_, half, settings_);
  const Eigen::VectorXd left = residuals({lights_[0]});
  const auto first = left.size() - left.size() / 2;
  EXPECT_NEAR(by_half.error(left), left.head(first).norm() / half.target_norm, 1e-12);
}

TEST(HeldOut, MissesWhatIsLargeAndNoNoise) {
  renderer::Scene scene;
  test::add_mesh(scene, test::room({4, 3, 4}, 2), test::lambert({0.6F, 0.5F, 0.4F}), "room");
  const renderer::RayTracer tracer(scene);
  const auto receivers = receivers_of(scene);
  // Two halves: on one the noise is a tenth of the light, on the other one per cent.
  const auto count = Eigen::Index(receivers.size()), half = count / 2;
  Observations observations = observations_of(Column::Constant(count, 3, 1 / std::sqrt(3.0)));
  observations.standard_error.head(half).setConstant(0.1);
  observations.standard_error.tail(count - half).setConstant(0.01);
  const HeldOut held_out(tracer, receivers, observations, observations,
                         {.samples = 16, .bounces = 0, .seed = 3, .materials = "gltf"});
  const auto missed = [&](double residual) { return held_out.part_missed(Eigen::VectorXd::Constant(count, residual)); };
  EXPECT_EQ(missed(0.25), 0);
  EXPECT_NEAR(missed(0.4), double(count - half) / double(count), 1e-12);
  EXPECT_NEAR(missed(0.6), 1, 1e-12);
}

TEST_F(HeldOutRoom, ResidualsOfASearchAreThose) {
  HeldOutSets of_search(*held_out_, 0.01);
  const Eigen::VectorXd expected = residuals(lights_);
  EXPECT_LT((of_search.residuals(lights_) - expected).norm(), 1e-5 * expected.norm());
  EXPECT_EQ(of_search.residuals(lights_), of_search.residuals(lights_));
  // Direct light and intensities are always those of now; indirect light hardly changes within a centimetre.
  LightEstimates moved = lights_;
  moved[0].position.x() += 0.005;
  moved[1].intensity *= 1.2;
  const Eigen::VectorXd near = residuals(moved);
  EXPECT_LT((of_search.residuals(moved) - near).norm(), 0.02 * near.norm());
  EXPECT_GT((near - expected).norm(), 0.05 * near.norm());
  moved[0].position.x() += 0.5;
  EXPECT_LT((of_search.residuals(moved) - residuals(moved)).norm(), 1e-5 * residuals(moved).norm());
}

TEST(HeldOut, NoiseAloneIsHardlyEverClear) {
  int clear = 0;
  for (std::uint32_t k = 0; k < 1000; ++k) {
    Eigen::VectorXd a(200), b(200);
    for (int i = 0; i < 200; ++i) {
      renderer::Sampler sampler(4, k, std::uint32_t(i));
      a[i] = double(sampler.next_1d());
      b[i] = double(sampler.next_1d());
    }
    clear += clearly_smaller(a, b) ? 1 : 0;
  }
  EXPECT_LE(clear, 8);  // 1.35 expected at three standard errors; more has a chance of 1 in 10⁵
}

}  // namespace
}  // namespace chiaro::inverse
