#include "inverse/solve/traced_light.h"

#include <gtest/gtest.h>

#include "inverse/solve/observe_target.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using tests::known_lights;
using tests::PaintedCorner;

class TraceForVerification : public ::testing::Test {
 protected:
  FreshTrace trace(const Target& target, const LightEstimates& lights, int asked_for = 0, double time_limit = 0) const {
    SolveOptions options;
    options.verification_samples = asked_for;
    const SolveProblem problem{corner_.tracer(), target, {}, {}, tests::bake_settings(-1), {}};
    return trace_for_verification(problem, point_lights(lights), options, {}, StageClock(time_limit));
  }
  int most() const { return verification_samples({}, corner_.receivers().size()); }

  PaintedCorner corner_{0.4F};
  LightEstimates known_ = known_lights(2);
};

TEST_F(TraceForVerification, TakesTheSamplesAskedFor) {
  EXPECT_EQ(trace(corner_.target(known_, -1), known_, 5).samples, 5);
}

TEST_F(TraceForVerification, TakesAllWhereTheLightsExplainATargetWithoutNoise) {
  Target target = corner_.target(known_, -1);
  target.illumination = trace(target, known_, 2 * most()).all.value;
  target.standard_error.clear();
  EXPECT_EQ(trace(target, known_).samples, most());
}

TEST_F(TraceForVerification, TakesFewWhereNoiseHardlyMatters) {
  const Target exact = corner_.target(known_, -1);
  Target noisy = exact;
  for (float& error : noisy.standard_error) error *= 8;
  const LightEstimates wrong{known_[1]};
  for (const FreshTrace& traced : {trace(noisy, known_), trace(exact, wrong)}) {
    EXPECT_LE(traced.samples, most() / 16);
  }
  EXPECT_LE(*relative_standard_error(trace(noisy, known_).all), 2 * target_noise(noisy));
}

// The same light by two lights and by eight: of few the trace may be twice as noisy as the target.
TEST_F(TraceForVerification, TakesMoreWhereManyLightsAreToBeToldApart) {
  Target target = corner_.target(known_, -1);
  const float scale = float(0.015 / target_noise(target));
  for (float& error : target.standard_error) error *= scale;
  LightEstimates many(7, known_[0]);
  for (LightEstimate& light : many) light.intensity /= 7;
  many.push_back(known_[1]);
  const FreshTrace of_few = trace(target, known_), of_many = trace(target, many);
  EXPECT_LT(of_few.samples, of_many.samples);
  EXPECT_LE(*noise_of(of_few, target), 2 * target_noise(target));
  EXPECT_LE(*noise_of(of_many, target), target_noise(target));
}

// By 64 paths and by a thousand: the error of lights that do not explain the target is the same but for what is known
// of the noise. With the noise it would be a tenth more.
TEST_F(TraceForVerification, ErrorIsThatOfTheLightsWithoutTheNoiseOfTheTrace) {
  const Target target = corner_.target(known_, -1);
  LightEstimates wrong = known_;
  wrong[0].intensity *= 1.2;
  const FreshTrace rough = trace(target, wrong, 64), fine = trace(target, wrong, 1024);
  const double error = error_without_noise(fine, target);
  EXPECT_NEAR(error_without_noise(rough, target), error, 0.04 * error);
  EXPECT_GT(relative_l2(rough.all.value, target.illumination, target.weight), 1.08 * error);
}

// Of the lights that made it a target has no error; the noise is known to a part of it, and so is this.
TEST_F(TraceForVerification, ErrorIsNoLessThanTheNoiseIsKnownTo) {
  Target target = corner_.target(known_, -1);
  target.illumination = trace(target, known_, 4096).all.value;
  const FreshTrace traced = trace(target, known_, 32);
  const double noise = *noise_of(traced, target), error = error_without_noise(traced, target);
  EXPECT_GT(error, 0.05 * noise);
  EXPECT_LT(error, 0.5 * noise);
}

TEST_F(TraceForVerification, TheSamePathsBringTheSameLight) {
  const Target target = corner_.target(known_, -1);
  const SolveProblem problem{corner_.tracer(), target, {}, {}, tests::bake_settings(-1), {}};
  const FreshTrace traced = trace(target, known_);
  ASSERT_GT(traced.parts.size(), 1U);
  const FreshTrace again = trace_by_the_same_paths(problem, point_lights(known_), traced, {}, {});
  EXPECT_EQ(again.samples, traced.samples);
  EXPECT_EQ(again.all.value, traced.all.value);
}

TEST_F(TraceForVerification, TakesAsFewAsThereIsTimeForAndSaysSo) {
  const Target exact = corner_.target(known_, -1);
  const FreshTrace late = trace(exact, known_, 0, 1e-9), in_time = trace(exact, known_, 0, 1000);
  EXPECT_EQ(late.samples, 16);
  EXPECT_TRUE(late.cut_short);
  EXPECT_GT(in_time.samples, 16);
  EXPECT_FALSE(in_time.cut_short);
  const FreshTrace asked_for = trace(exact, known_, 40, 1e-9);
  EXPECT_EQ(asked_for.samples, 40) << "what was asked for is what it takes";
  EXPECT_FALSE(asked_for.cut_short);
}

// In two parts, and as one as long: the same light within both their standard errors. Of the thousands of receivers and
// channels 1 in 370 may be beyond three of them; standard errors are of four batches, which makes that 1 in 25.
TEST_F(TraceForVerification, BothPartsCountByTheirSamples) {
  Target target = corner_.target(known_, -1);
  target.standard_error.clear();
  target.illumination = trace(target, known_, 2 * most()).all.value;
  const FreshTrace parts = trace(target, known_), whole = trace(target, known_, most());
  ASSERT_EQ(parts.samples, whole.samples);
  EXPECT_NEAR(*relative_standard_error(parts.all), *relative_standard_error(whole.all),
              0.1 * *relative_standard_error(whole.all));
  std::size_t beyond = 0, all = 0;
  for (std::size_t i = 0; i < whole.all.value.size(); ++i) {
    const Vec3f sum = parts.of_light[0][i] + parts.of_light[1][i];
    for (int c = 0; c < 3; ++c, ++all) {
      const double error = std::hypot(parts.all.standard_error[i][c], whole.all.standard_error[i][c]);
      if (std::abs(parts.all.value[i][c] - whole.all.value[i][c]) > 3 * error) ++beyond;
      EXPECT_NEAR(sum[c], parts.all.value[i][c], 1e-4 * double(parts.all.value[i][c]));
    }
  }
  EXPECT_LT(beyond, all / 25);
}

}  // namespace
}  // namespace chiaro::inverse
