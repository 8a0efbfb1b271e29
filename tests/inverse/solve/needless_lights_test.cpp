#include "inverse/solve/needless_lights.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

// Receivers that get direct light, of a target that is noisy.
class NeedlessLights : public ::testing::Test {
 protected:
  static constexpr int kReceivers = 1800;

  NeedlessLights() : bench_{problem_.response(), problem_.observations()} {
    noise_ = noise_up_to(0.1 * bench_.observations.wanted.mean(), kReceivers);
    bench_.observations.wanted += noise_;
  }

  // Where they stand, none of them with light by bounces.
  FreeLights standing(const LightEstimates& lights) const {
    FreeLights free;
    free.traced = free.now = lights;
    for (std::size_t j = 0; j < lights.size(); ++j) {
      free.brought.push_back(direct(lights[j]));
      free.indirect_traced.push_back(Column::Zero(noise_.rows(), 3));
      free.number.push_back(j);
    }
    free.indirect = free.indirect_traced;
    return free;
  }

  Column direct(const LightEstimate& light) const {
    return problem_.response().direct(light.position) * light.intensity.matrix().asDiagonal();
  }

  const LightEstimates known_ = known_lights(2);
  const DirectProblem problem_{known_, kReceivers};
  Column noise_{kReceivers, 3};
  SettlingBench bench_;
};

TEST_F(NeedlessLights, GoAndOthersStay) {
  LightEstimates lights = known_;
  lights.push_back({{2, 2, 2}, {0.01, 0.01, 0.01}});
  lights.push_back({{1.5, 2.2, 1}, {0.01, 0.01, 0.01}});
  FreeLights free = standing(lights);
  const LightIntervals intervals = remove_needless(bench_, nullptr, free);
  EXPECT_EQ(free.number, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(intervals.lights.size(), 2U);
  EXPECT_LT(farthest_from(known_, positions_of(free.now)), 0.01);
}

TEST_F(NeedlessLights, OneStays) {
  FreeLights free = standing({{{2, 2, 2}, {0.001, 0.001, 0.001}}});
  remove_needless(bench_, nullptr, free);
  EXPECT_EQ(free.now.size(), 1U);
}

// A weak light makes good what is wrong with another's light by bounces, until that is carried along.
TEST_F(NeedlessLights, FewerAreJudgedByTheirLightByBouncesWhereTheyStand) {
  LightEstimate weak{{0.5, 0.5, 3.5}, Array3d::Ones()};
  weak.intensity *= 0.3 * noise_.norm() / direct(weak).norm();
  FreeLights free = standing({known_[0], known_[1], weak});
  const Column missing = direct(weak) * known_[0].intensity.inverse().matrix().asDiagonal();
  free.indirect[0] = free.indirect_traced[0] = -missing;
  FreeLights on_the_way = free;
  remove_needless(bench_, nullptr, on_the_way);
  EXPECT_EQ(on_the_way.now.size(), 3U);
  const CarryAlong carry_along = [&](FreeLights& fewer) {
    fewer.indirect[0] += missing;
    bench_.descend(fewer.indirect, fewer.now);
  };
  remove_needless(bench_, carry_along, free);
  EXPECT_EQ(free.number, (std::vector<std::size_t>{0, 1}));
}

// Where few paths tell how a light's bright spot on a wall nearby changed it is noise.
TEST_F(NeedlessLights, WhatIsMostlyNoiseIsNotCarriedAlong) {
  const double amplitude = direct(known_[0]).norm() / noise_.norm();
  const auto carried_with_noise = [&](double part) {
    return [&, part](FreeLights& free) {
      free.indirect[0] += part * amplitude * noise_ * known_[0].intensity.inverse().matrix().asDiagonal();
      bench_.descend(free.indirect, free.now);
    };
  };
  FreeLights free = standing(known_);
  EXPECT_FALSE(come_along(bench_, carried_with_noise(0.3), free));
  EXPECT_EQ(free.indirect[0].norm(), 0);
  EXPECT_EQ(positions_of(free.now), positions_of(known_));
  EXPECT_TRUE(come_along(bench_, carried_with_noise(0.001), free));
  EXPECT_GT(free.indirect[0].norm(), 0);
}

TEST(FreeLights, WithoutSomeKeepTheOthersTogether) {
  FreeLights free;
  for (std::size_t j = 0; j < 4; ++j) {
    free.traced.push_back({Vector3d::Constant(double(j)), Array3d::Ones()});
    free.brought.push_back(Column::Constant(2, 3, double(j)));
    free.number.push_back(10 + j);
  }
  free.now = free.traced;
  free.indirect = free.indirect_traced = free.brought;
  const FreeLights fewer = without(free, {0, 2});
  EXPECT_EQ(fewer.number, (std::vector<std::size_t>{11, 13}));
  EXPECT_EQ(fewer.now[1].position.x(), 3);
  EXPECT_EQ(fewer.traced[0].position.x(), 1);
  EXPECT_EQ(fewer.brought[1](0, 0), 3);
  EXPECT_EQ(fewer.indirect[0](0, 0), 1);
  EXPECT_EQ(fewer.indirect_traced[1](0, 0), 3);
  EXPECT_TRUE(fewer.carried.empty());
}

}  // namespace
}  // namespace chiaro::inverse
