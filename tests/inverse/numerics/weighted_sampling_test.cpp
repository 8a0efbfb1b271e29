#include "inverse/numerics/weighted_sampling.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>

namespace chiaro::inverse::numerics {
namespace {

using Indices = std::vector<std::size_t>;

// The probability of every set of `count`, by drawing one after the other in every order.
void add_set_probabilities(const std::vector<double>& weights, std::size_t count, Indices drawn, double probability,
                           std::map<Indices, double>& sets) {
  if (drawn.size() == count) {
    std::sort(drawn.begin(), drawn.end());
    sets[drawn] += probability;
    return;
  }
  double left = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (const std::size_t i : drawn) left -= weights[i];
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (std::find(drawn.begin(), drawn.end(), i) != drawn.end() || weights[i] == 0) continue;
    Indices next = drawn;
    next.push_back(i);
    add_set_probabilities(weights, count, next, probability * weights[i] / left, sets);
  }
}

// Pearson's statistic of how often every set was drawn, over `trials` seeds from `first_seed` on.
double chi_square(const std::vector<double>& weights, std::size_t count, int trials, std::uint64_t first_seed) {
  std::map<Indices, double> expected;
  add_set_probabilities(weights, count, {}, 1, expected);
  std::map<Indices, int> drawn;
  for (int i = 0; i < trials; ++i) ++drawn[sample_without_replacement(weights, count, first_seed + std::uint64_t(i))];
  double sum = 0;
  for (const auto& [set, probability] : expected) {
    const double mean = trials * probability;
    sum += std::pow(drawn[set] - mean, 2) / mean;
    drawn.erase(set);
  }
  return drawn.empty() ? sum : INFINITY;  // a set that cannot be drawn
}

// Critical values of the chi-square distribution at a significance of 0.1 %.
constexpr double kCritical4 = 18.47, kCritical9 = 27.88, kCritical19 = 43.82;

TEST(WeightedSampling, OneOfFiveHasTheProbabilityOfItsWeight) {
  EXPECT_LT(chi_square({1, 2, 3, 4, 10}, 1, 40000, 1), kCritical4);
}

TEST(WeightedSampling, PairsAndTriplesHaveTheirExactProbabilities) {
  EXPECT_LT(chi_square({1, 2, 3, 4, 10}, 2, 40000, 100000), kCritical9);
  EXPECT_LT(chi_square({5, 1, 1, 2, 0.5, 3}, 3, 60000, 200000), kCritical19);
  EXPECT_LT(chi_square({1, 1, 1, 1, 1}, 3, 40000, 300000), kCritical9);
}

TEST(WeightedSampling, InclusionFrequenciesAreExact) {
  const std::vector<double> weights{0.1, 1, 2, 4};
  std::map<Indices, double> sets;
  add_set_probabilities(weights, 2, {}, 1, sets);
  const int trials = 50000;
  std::vector<double> expected(4, 0), found(4, 0);
  for (const auto& [set, probability] : sets) {
    for (const std::size_t i : set) expected[i] += probability;
  }
  for (int seed = 0; seed < trials; ++seed) {
    for (const std::size_t i : sample_without_replacement(weights, 2, std::uint64_t(seed))) found[i] += 1.0 / trials;
  }
  for (int i = 0; i < 4; ++i) {
    const double sigma = std::sqrt(expected[i] * (1 - expected[i]) / trials);
    EXPECT_NEAR(found[i], expected[i], 3.9 * sigma);  // two-sided significance 0.01 %
  }
}

TEST(WeightedSampling, InclusionProbabilitiesAreThoseOfManyDraws) {
  std::vector<double> weights;
  for (int i = 0; i < 300; ++i) weights.push_back(0.02 + std::pow(double(i % 30) / 29, 3));
  const std::vector<double> expected = inclusion_probabilities(weights, 60);
  EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 60, 1e-6);
  const int trials = 20000;
  std::vector<double> found(30, 0);  // of each kind of weight
  for (int seed = 0; seed < trials; ++seed) {
    for (const std::size_t i : sample_without_replacement(weights, 60, std::uint64_t(seed)))
      found[i % 30] += 0.1 / trials;
  }
  for (int k = 0; k < 30; ++k) {
    const double sigma = std::sqrt(expected[k] * (1 - expected[k]) / (10.0 * trials));
    EXPECT_NEAR(found[k], expected[k], 4 * sigma + 1e-3) << weights[k];
  }
}

TEST(WeightedSampling, InclusionIsCertainWhereAllAreTaken) {
  EXPECT_EQ(inclusion_probabilities(std::vector<double>{2, 0, 1e-9}, 2), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(inclusion_probabilities(std::vector<double>{0, 0}, 1), (std::vector<double>{0, 0}));
  EXPECT_TRUE(inclusion_probabilities({}, 3).empty());
}

TEST(WeightedSampling, TheUnitOfTheWeightsDoesNotMatter) {
  const std::vector<double> weights{1, 2, 3, 4, 5, 6, 7};
  for (const double unit : {0x1p-1000, 0x1p-100, 0x1p100, 0x1p1000}) {
    std::vector<double> scaled = weights;
    for (double& w : scaled) w *= unit;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      EXPECT_EQ(sample_without_replacement(scaled, 3, seed), sample_without_replacement(weights, 3, seed));
    }
  }
}

TEST(WeightedSampling, ChosenIndicesAreDistinctAndAscending) {
  std::vector<double> weights(1000);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = double(i % 17);
  const Indices chosen = sample_without_replacement(weights, 300, 4);
  ASSERT_EQ(chosen.size(), 300U);
  for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_LT(chosen[i - 1], chosen[i]);
  EXPECT_LT(chosen.back(), 1000U);
}

TEST(WeightedSampling, ZeroWeightsComeOnlyWhenNoOthersAreLeft) {
  const std::vector<double> weights{0, 1e-300, 0, 5, 0, 1e300};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    EXPECT_EQ(sample_without_replacement(weights, 3, seed), (Indices{1, 3, 5}));
    const Indices four = sample_without_replacement(weights, 4, seed);
    ASSERT_EQ(four.size(), 4U);
    for (const std::size_t i : {1U, 3U, 5U}) EXPECT_TRUE(std::binary_search(four.begin(), four.end(), i));
  }
  EXPECT_EQ(sample_without_replacement(std::vector<double>(5, 0), 2, 9).size(), 2U);
}

TEST(WeightedSampling, AsManyAsThereAreOrMoreAreAll) {
  const std::vector<double> weights{3, 0, 1};
  EXPECT_EQ(sample_without_replacement(weights, 3, 1), (Indices{0, 1, 2}));
  EXPECT_EQ(sample_without_replacement(weights, 99, 1), (Indices{0, 1, 2}));
  EXPECT_TRUE(sample_without_replacement(weights, 0, 1).empty());
  EXPECT_TRUE(sample_without_replacement({}, 5, 1).empty());
}

TEST(WeightedSampling, IsAFunctionOfItsArguments) {
  const std::vector<double> weights(500, 1.0);
  EXPECT_EQ(sample_without_replacement(weights, 50, 7), sample_without_replacement(weights, 50, 7));
  EXPECT_NE(sample_without_replacement(weights, 50, 7), sample_without_replacement(weights, 50, 8));
}

TEST(WeightedSampling, RefusesWeightsThatAreNone) {
  for (const double bad : {-1.0, double(NAN), double(INFINITY)}) {
    EXPECT_THROW(sample_without_replacement(std::vector<double>{1, bad}, 1, 0), std::invalid_argument);
  }
}

}  // namespace
}  // namespace chiaro::inverse::numerics
