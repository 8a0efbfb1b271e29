// Which receivers gather, and what the others take from them. Seeds are fixed.

#include "inverse/transport/irradiance_records.h"

#include <gtest/gtest.h>

#include "inverse/transport/receivers.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::Scene;

class IrradianceRecordsOf : public testing::Test {
 protected:
  Scene scene = test::corner_with_ball();
  RayTracer tracer{scene};
  Receivers receivers = make_receivers(scene, {.max_edge = 0.05F});
  IrradianceRecords records = choose_irradiance_records(tracer, receivers.samples, 1);

  double share_of(std::size_t receiver, const std::vector<double>& values) const {
    double sum = 0;
    for (const auto& [record, weight] : records.of(receiver)) sum += double(weight) * values[record];
    return sum;
  }
};

TEST_F(IrradianceRecordsOf, AreSomeOfTheReceivers) {
  EXPECT_LT(records.receivers.size(), receivers.size() / 3);
  EXPECT_GT(records.receivers.size(), 100U);
  EXPECT_TRUE(std::is_sorted(records.receivers.begin(), records.receivers.end()));
  ASSERT_EQ(records.share_start.size(), receivers.size() + 1);
  for (std::size_t k = 0; k < records.receivers.size(); ++k) {
    const auto own = records.of(records.receivers[k]);
    ASSERT_EQ(own.size(), 1U);
    EXPECT_EQ(own[0].record, k);
    EXPECT_EQ(own[0].weight, 1);
  }
}

// A function of position that is linear is the same at every flat receiver, interpolated or not.
TEST_F(IrradianceRecordsOf, GiveLinearFunctionsExactly) {
  const auto linear = [](Vec3f p) { return 1 + 0.5 * double(p.x) - 0.7 * double(p.y) + 0.3 * double(p.z); };
  std::vector<double> values;
  for (const std::size_t i : records.receivers) values.push_back(linear(receivers.samples[i].position));
  std::size_t interpolated = 0;
  for (const Receivers::Part& part : receivers.parts) {
    const std::size_t first = part.first_receiver, last = first + part.receiver_count;
    const bool flat = receivers.normals[first] == receivers.normals[last - 1];
    for (std::size_t i = first; i < last; ++i) {
      const double expected = linear(receivers.samples[i].position);
      EXPECT_NEAR(share_of(i, values), expected, flat ? 1e-3 : 2e-2) << part.name;
      interpolated += records.of(i).size() > 1 ? 1 : 0;
    }
  }
  EXPECT_EQ(interpolated, receivers.size() - records.receivers.size());
}

TEST_F(IrradianceRecordsOf, StandDenserNearOtherSurfaces) {
  // The floor at the foot of the walls, and farther from them and from the ball.
  std::size_t near = 0, near_records = 0, far = 0, far_records = 0;
  std::vector<char> is_record(receivers.size(), 0);
  for (const std::size_t i : records.receivers) is_record[i] = 1;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const renderer::Vec3f p = receivers.samples[i].position, n = receivers.samples[i].normal;
    if (n.y < 0.99F || p.y > 0.01F) continue;
    const bool at_wall = p.x < 0.2F || p.z < 0.2F;
    (at_wall ? near : far) += 1;
    (at_wall ? near_records : far_records) += std::size_t(is_record[i]);
  }
  EXPECT_GT(double(near_records) / double(near), 2 * double(far_records) / double(far));
}

TEST_F(IrradianceRecordsOf, SomeReceiversNeedSomeRecords) {
  const std::vector<std::size_t> chosen{5, 700, 333, 334, receivers.size() - 1};
  const IrradianceRecords some = records_of(records, chosen);
  EXPECT_LE(some.receivers.size(), 50U);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto all_shares = records.of(chosen[k]), shares = some.of(k);
    ASSERT_EQ(shares.size(), all_shares.size());
    for (std::size_t s = 0; s < shares.size(); ++s) {
      EXPECT_EQ(some.receivers[shares[s].record], records.receivers[all_shares[s].record]);
      EXPECT_EQ(shares[s].weight, all_shares[s].weight);
    }
  }
}

TEST_F(IrradianceRecordsOf, AreTheSameOnOneThread) {
  const renderer::ThreadLimit one(1);
  const IrradianceRecords again = choose_irradiance_records(tracer, receivers.samples, 1);
  EXPECT_EQ(again.receivers, records.receivers);
  ASSERT_EQ(again.shares.size(), records.shares.size());
  for (std::size_t s = 0; s < again.shares.size(); ++s) EXPECT_EQ(again.shares[s].weight, records.shares[s].weight);
}

}  // namespace
}  // namespace chiaro::inverse
