#include "inverse/transport/interreflection.h"

#include <gtest/gtest.h>

#include <atomic>

#include <Eigen/LU>

#include "renderer/core/error.h"
#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

using renderer::Vec3f;

constexpr int kPoints = 120;

// Each point sees a dozen others and reflects as much of them as `albedo` says; each pair of `touching` ones hardly
// anything but each other, as in a narrow gap.
std::vector<std::vector<SparseTransport::Entry>> random_bounces(Vec3f albedo, bool touching) {
  std::vector<std::vector<SparseTransport::Entry>> rows(kPoints);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    renderer::Sampler sampler(5, i, 0);
    const bool in_gap = touching && i < 8;
    for (int k = 0; k < 12; ++k) {
      const auto other = std::uint32_t(sampler.next_1d() * kPoints) % kPoints;
      rows[i].push_back({in_gap && k > 0 ? i ^ 1U : other, albedo / 12});
    }
  }
  return rows;
}

Eigen::MatrixXd dense(const SparseTransport& matrix, int channel) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(kPoints, kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    for (const auto& entry : matrix.row(i)) result(Eigen::Index(i), entry.column) = double(entry.weight[channel]);
  }
  return result;
}

// Light on some points by each of the lights.
template <class Lanes>
std::vector<Lanes> direct_light() {
  std::vector<Lanes> direct(kPoints);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    renderer::Sampler sampler(6, i, 0);
    for (auto& channel : direct[i].channel) {
      for (float& value : channel) value = sampler.next_1d() < 0.2F ? sampler.next_1d() : 0;
    }
  }
  return direct;
}

template <class Lanes>
Eigen::MatrixXd lanes_of(const std::vector<Lanes>& light, int channel) {
  Eigen::MatrixXd result(kPoints, Lanes::kLanes);
  for (int i = 0; i < kPoints; ++i) {
    for (int l = 0; l < Lanes::kLanes; ++l) result(i, l) = double(light[std::size_t(i)].channel[channel][l]);
  }
  return result;
}

template <class Lanes>
void expect_solution(const Interreflection& k, const std::vector<Lanes>& direct) {
  const std::vector<Lanes> found = sum_of_bounces(k, direct, -1);
  for (int c = 0; c < 3; ++c) {
    const Eigen::MatrixXd system = Eigen::MatrixXd::Identity(kPoints, kPoints) - dense(k.one_bounce, c);
    const Eigen::MatrixXd expected = system.partialPivLu().solve(lanes_of(direct, c));
    EXPECT_LT((lanes_of(found, c) - expected).norm(), 1e-3 * expected.norm()) << "channel " << c;
  }
}

TEST(Interreflection, AllBouncesSolveTheSystem) {
  for (const bool touching : {false, true}) {
    for (const Vec3f albedo : {Vec3f{0.7F, 0.5F, 0.3F}, Vec3f{0.98F, 0.1F, 0}}) {
      const auto k = make_interreflection(SparseTransport::from_rows(random_bounces(albedo, touching)));
      expect_solution(k, direct_light<LightBlock>());
      expect_solution(k, direct_light<LightQuad>());
      expect_solution(k, direct_light<OneLight>());
      expect_solution(transposed(k), direct_light<LightBlock>());
    }
  }
}

TEST(Interreflection, SpectralRadiusIsTheLargestEigenvalue) {
  const Vec3f albedo{0.7F, 0.5F, 0.98F};
  const auto k = make_interreflection(SparseTransport::from_rows(random_bounces(albedo, false)));
  for (int c = 0; c < 3; ++c) {
    // Rows of equal sums: that sum.
    EXPECT_NEAR(k.spectral_radius[std::size_t(c)], double(albedo[c]), 1e-5);
  }
}

TEST(Interreflection, SoManyBouncesAreTheFirstTermsOfTheSeries) {
  const auto k = make_interreflection(SparseTransport::from_rows(random_bounces({0.7F, 0.5F, 0.3F}, true)));
  const auto direct = direct_light<LightBlock>();
  const Eigen::MatrixXd d = lanes_of(direct, 0), kk = dense(k.one_bounce, 0);
  EXPECT_LT((lanes_of(sum_of_bounces(k, direct, 1), 0) - d).norm(), 1e-6 * d.norm());
  const Eigen::MatrixXd three = d + kk * (d + kk * d);
  EXPECT_LT((lanes_of(sum_of_bounces(k, direct, 3), 0) - three).norm(), 1e-6 * three.norm());
}

TEST(Interreflection, CanBeInterrupted) {
  const std::atomic<bool> interrupted{true};
  const renderer::Control control{.report = {}, .report_noise = {}, .interrupted = &interrupted};
  const auto k = make_interreflection(SparseTransport::from_rows(random_bounces({0.7F, 0.5F, 0.3F}, true)));
  for (const int bounces : {-1, 3}) {
    EXPECT_THROW(sum_of_bounces(k, direct_light<LightQuad>(), bounces, control), renderer::Interruption) << bounces;
  }
}

TEST(Interreflection, WithoutAnyItIsDirectLight) {
  const auto k =
      make_interreflection(SparseTransport::from_rows(std::vector<std::vector<SparseTransport::Entry>>(kPoints)));
  const auto direct = direct_light<LightQuad>();
  EXPECT_EQ((lanes_of(sum_of_bounces(k, direct, -1), 1) - lanes_of(direct, 1)).norm(), 0);
}

}  // namespace
}  // namespace chiaro::inverse
