#include "inverse/solve/pooled_errors.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

constexpr int kSide = 40, kBatches = 4;

// A floor and the underside of a board right above it, a hundred times as noisy. Standard errors as few batches of
// normal noise tell them.
Target floor_below_a_board(double of_floor, double of_board) {
  Target target;
  std::mt19937 random(7);
  std::chi_squared_distribution<double> chi_squared(kBatches - 1);
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < kSide * kSide; ++i) {
      const renderer::Vec3f at{float(i % kSide), float(i / kSide), side == 0 ? 0.0F : 0.01F};
      target.receivers.samples.push_back({at, {0, 0, side == 0 ? 1.0F : -1.0F}});
      target.illumination.push_back({1, 1, 1});
      target.weight.push_back(1);
      const double told = std::sqrt(chi_squared(random) / (kBatches - 1));
      target.standard_error.push_back(float((side == 0 ? of_floor : of_board) * told));
    }
  }
  return target;
}

TEST(PooledStandardErrors, AreThoseOfTheSurfaceAboutAReceiver) {
  const Target target = floor_below_a_board(0.01, 1);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < target.receivers.samples.size(); i += 7) chosen.push_back(i);
  const std::vector<float> pooled = pooled_standard_errors(target, chosen);
  ASSERT_EQ(pooled.size(), chosen.size());
  // Variances of 16 receivers with 3 degrees of freedom each: relative standard deviation √(2 / 48), here at five.
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const double expected = chosen[k] < kSide * kSide ? 0.01 : 1;
    EXPECT_NEAR(std::pow(double(pooled[k]) / expected, 2), 1, 5 * std::sqrt(2.0 / 48)) << chosen[k];
  }
}

// Those that no picture shows say nothing, and have any value there.
TEST(PooledStandardErrors, AreOfReceiversThatWeighSomething) {
  Target target = floor_below_a_board(0.01, 1);
  for (std::size_t i = 0; i < target.weight.size(); i += 2) target.weight[i] = 0;
  const std::vector<float> before = pooled_standard_errors(target, {1, 41, 1001});
  for (std::size_t i = 0; i < target.weight.size(); i += 2) target.standard_error[i] = 1000;
  EXPECT_EQ(pooled_standard_errors(target, {1, 41, 1001}), before);
}

// Weights by what few batches tell favour receivers whose batches agree by chance.
TEST(PooledStandardErrors, TellTheNoiseOfAWeightedMean) {
  const Target target = floor_below_a_board(1, 1);
  std::vector<std::size_t> all(target.receivers.samples.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const std::vector<float> pooled = pooled_standard_errors(target, all);
  // The true error being 1 everywhere, Σ 1/σ̂² is the squared residual that receivers so weighted are to have.
  double of_pooled = 0, of_own = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    of_pooled += 1 / std::pow(double(pooled[i]), 2) / double(all.size());
    of_own += 1 / std::pow(double(target.standard_error[i]), 2) / double(all.size());
  }
  // 200 neighbourhoods have no receiver in common; their squared errors vary by √(2 / 48).
  EXPECT_NEAR(of_pooled, 48.0 / 46, 5 * std::sqrt(2.0 / 48 / 200));
  EXPECT_GT(of_own, 2);
}

TEST(PooledStandardErrors, AreUnknownWhereTheTargetDoesNotSay) {
  Target target = floor_below_a_board(1, 1);
  target.standard_error.clear();
  EXPECT_TRUE(pooled_standard_errors(target, {0, 1}).empty());
}

}  // namespace
}  // namespace chiaro::inverse
