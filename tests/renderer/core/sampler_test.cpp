// Statistical bounds: fixed seeds; each false alarm would have p < 0.1 %.

#include "renderer/core/sampler.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace chiaro::renderer {
namespace {

constexpr std::uint32_t kPower = 8, kCount = 1U << kPower;

// The first kCount samples of a stream, per pair of dimensions.
std::vector<std::vector<Vec2f>> pairs_of_stream(std::uint64_t seed, std::uint32_t stream, int pairs) {
  std::vector<std::vector<Vec2f>> points(pairs);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    Sampler sampler(seed, stream, i);
    for (int d = 0; d < pairs; ++d) points[d].push_back(sampler.next_2d());
  }
  return points;
}

TEST(Sampler, EveryElementaryIntervalHoldsOnePoint) {
  // A (0, 8, 2)-net: each of the 256 boxes of 2^-a × 2^-(8-a) has one point, for every a.
  for (const std::uint64_t seed : {0ULL, 7ULL, 0x123456789abcdefULL}) {
    for (const std::uint32_t stream : {0U, 1U, 4711U}) {
      for (const auto& points : pairs_of_stream(seed, stream, 4)) {
        for (std::uint32_t a = 0; a <= kPower; ++a) {
          std::set<std::uint32_t> boxes;
          for (const Vec2f p : points) {
            const auto x = std::uint32_t(p.x * float(1U << a)), y = std::uint32_t(p.y * float(1U << (kPower - a)));
            boxes.insert((x << (kPower - a)) | y);
          }
          ASSERT_EQ(boxes.size(), kCount) << "seed " << seed << ", stream " << stream << ", a " << a;
        }
      }
    }
  }
}

TEST(Sampler, OneDimensionIsStratified) {
  std::set<std::uint32_t> strata;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    Sampler sampler(5, 3, i);
    sampler.next_2d();
    strata.insert(std::uint32_t(sampler.next_1d() * float(kCount)));
  }
  EXPECT_EQ(strata.size(), kCount);
}

TEST(Sampler, FirstSamplesOfStreamsAreUniform) {
  // Streams are what pixels differ by. 64 bins: χ² of 63 degrees of freedom, 99.9 % quantile 103.4.
  constexpr int kBins = 64;
  constexpr std::uint32_t kStreams = 64000;
  std::vector<int> x(kBins), y(kBins), z(kBins);
  for (std::uint32_t stream = 0; stream < kStreams; ++stream) {
    Sampler sampler(1, stream, 0);
    const Vec2f p = sampler.next_2d();
    ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
    ++x[int(p.x * kBins)], ++y[int(p.y * kBins)], ++z[int(sampler.next_1d() * kBins)];
  }
  const double expected = double(kStreams) / kBins;
  for (const auto& bins : {x, y, z}) {
    double chi_squared = 0;
    for (const int n : bins) chi_squared += (n - expected) * (n - expected) / expected;
    EXPECT_LT(chi_squared, 103.4);
    EXPECT_GT(chi_squared, 32.5);  // 0.1 %: more even than chance
  }
}

// Correlation of the values that two samplers give, over many of them; of standard deviation 1/√count.
template <class A, class B>
double correlation(std::uint32_t count, const A& a, const B& b) {
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) sum += 12 * (double(a(i)) - 0.5) * (double(b(i)) - 0.5);
  return sum / count;
}

TEST(Sampler, SeedsStreamsAndDimensionsAreUncorrelated) {
  constexpr std::uint32_t kMany = 20000;
  const auto first = [](std::uint64_t seed, std::uint32_t stream) { return Sampler(seed, stream, 0).next_1d(); };
  const auto second = [](std::uint32_t stream) {
    Sampler sampler(1, stream, 0);
    sampler.next_1d();
    return sampler.next_1d();
  };
  const double bound = 3.3 / std::sqrt(double(kMany));
  const auto base = [&](std::uint32_t i) { return first(1, i); };
  EXPECT_LT(std::abs(correlation(kMany, base, [&](std::uint32_t i) { return first(1, i + 1); })), bound);
  EXPECT_LT(std::abs(correlation(kMany, base, [&](std::uint32_t i) { return first(2, i); })), bound);
  EXPECT_LT(std::abs(correlation(kMany, base, [&](std::uint32_t i) { return first(1 + (1ULL << 32), i); })), bound);
  EXPECT_LT(std::abs(correlation(kMany, base, second)), bound);
}

TEST(Sampler, PairsOfDimensionsAreNotCoupled) {
  // Padded pairs: the 4D points of one stream, each pair stratified, must fill all of 4 × 4 boxes of (x of pair 0, x of
  // pair 1) evenly. 15 degrees of freedom, 99.9 % quantile 37.7.
  std::vector<double> bins(16);
  for (std::uint32_t stream = 0; stream < 16; ++stream) {
    const auto points = pairs_of_stream(9, stream, 2);
    for (std::uint32_t i = 0; i < kCount; ++i) ++bins[int(points[0][i].x * 4) * 4 + int(points[1][i].x * 4)];
  }
  double chi_squared = 0;
  for (const double n : bins) chi_squared += (n - kCount) * (n - kCount) / kCount;
  EXPECT_LT(chi_squared, 37.7);
}

// Variance of the mean of `count` points of one stream, over 512 streams, in that of independent random points.
template <class F>
double variance_in_random(std::uint32_t count, double mean, double variance, const F& f) {
  constexpr std::uint32_t kStreams = 512;
  double error = 0;
  for (std::uint32_t stream = 0; stream < kStreams; ++stream) {
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      Sampler sampler(3, stream, i);
      sampler.next_2d();
      sum += f(sampler.next_2d());
    }
    error += std::pow(sum / count - mean, 2) / kStreams;
  }
  return error / (variance / count);
}

TEST(Sampler, ErrorsFallFasterThanThoseOfRandomPoints) {
  // Owen, Scrambled Net Variance for Integrals of Smooth Functions, 1997: N⁻³ for smooth integrands, so that against
  // random points' N⁻¹ a factor of 16 each time N is four times as large; N^(−3/2), a factor of 2, across edges.
  const auto smooth = [](Vec2f u) { return double(u.x) * double(u.y); };
  const auto edge = [](Vec2f u) { return u.x + u.y < 1 ? 1.0 : 0.0; };
  const double smooth_64 = variance_in_random(64, 0.25, 7.0 / 144, smooth);
  const double smooth_256 = variance_in_random(256, 0.25, 7.0 / 144, smooth);
  EXPECT_LT(smooth_64, 0.005);
  EXPECT_LT(smooth_256, smooth_64 / 8);
  const double edge_64 = variance_in_random(64, 0.5, 0.25, edge), edge_256 = variance_in_random(256, 0.5, 0.25, edge);
  EXPECT_LT(edge_64, 0.25);
  EXPECT_LT(edge_256, edge_64 / 1.5);
}

TEST(Sampler, SameArgumentsGiveSameNumbers) {
  Sampler a(3, 4, 5), b(3, 4, 5);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.next_bits(), b.next_bits());
}

TEST(Sampler, CosineHemisphereHasItsMoments) {
  // E z = 2/3, E z² = 1/2, E x = E y = 0.
  double x = 0, y = 0, z = 0, z2 = 0;
  constexpr std::uint32_t kMany = 1U << 14;
  for (std::uint32_t i = 0; i < kMany; ++i) {
    const Vec3f d = sample_cosine_hemisphere(Sampler(1, 0, i).next_2d());
    EXPECT_NEAR(length(d), 1, 1e-6F);
    EXPECT_GE(d.z, 0);
    x += double(d.x), y += double(d.y), z += double(d.z), z2 += double(d.z) * double(d.z);
  }
  EXPECT_NEAR(x / kMany, 0, 1e-3);
  EXPECT_NEAR(y / kMany, 0, 1e-3);
  EXPECT_NEAR(z / kMany, 2.0 / 3, 1e-3);
  EXPECT_NEAR(z2 / kMany, 0.5, 1e-3);
}

}  // namespace
}  // namespace chiaro::renderer
