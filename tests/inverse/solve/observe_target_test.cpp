#include "inverse/solve/observe_target.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

constexpr std::size_t kMost = 101;

// Every seventh receiver counts for nothing.
class Draws : public testing::Test {
 protected:
  void SetUp() override {
    target_.receivers = corner_.receivers();
    target_.illumination.resize(target_.receivers.size());
    for (std::size_t i = 0; i < target_.receivers.size(); ++i) target_.weight.push_back(i % 7 == 3 ? 0.0F : 1.0F);
    weighted_ = std::size_t(std::count(target_.weight.begin(), target_.weight.end(), 1.0F));
    ASSERT_GT(weighted_, 4 * kMost);
  }

  // As many as asked for, each once, ascending, none that counts for nothing; together they stand for all.
  void expect_sound(const ReceiverDraw& draw) const {
    ASSERT_EQ(draw.chosen.size(), kMost);
    ASSERT_EQ(draw.probability.size(), kMost);
    double stand_for = 0;
    for (std::size_t k = 0; k < kMost; ++k) {
      EXPECT_EQ(target_.weight[draw.chosen[k]], 1);
      if (k > 0) {
        EXPECT_LT(draw.chosen[k - 1], draw.chosen[k]);
      }
      stand_for += 1 / draw.probability[k];
    }
    EXPECT_NEAR(stand_for, double(weighted_), 1e-6 * double(weighted_));
  }

  const tests::PaintedCorner corner_;
  Target target_;
  std::size_t weighted_ = 0;
};

TEST_F(Draws, AreSpreadEvenly) {
  const ReceiverDraw draw = draw_evenly(target_, kMost);
  expect_sound(draw);
  const std::size_t step = target_.receivers.size() / kMost;
  for (std::size_t k = 1; k < kMost; ++k) EXPECT_LE(draw.chosen[k] - draw.chosen[k - 1], step + 3);
}

// An even draw would hold few of twenty receivers that are lit among thousands.
TEST_F(Draws, HoldTheFewThatAreLit) {
  std::vector<std::size_t> lit;
  for (std::size_t i = 1; i < target_.receivers.size() && lit.size() < 20; i += target_.receivers.size() / 25) {
    if (target_.weight[i] == 0) continue;
    target_.illumination[i] = {1, 2, 3};
    lit.push_back(i);
  }
  ASSERT_GT(lit.size(), 10U);
  const ReceiverDraw draw = draw_with_the_lit(target_, kMost);
  expect_sound(draw);
  for (const std::size_t i : lit) EXPECT_TRUE(std::binary_search(draw.chosen.begin(), draw.chosen.end(), i)) << i;
}

TEST_F(Draws, HoldTheBrightestAndSomeOfTheRest) {
  Eigen::VectorXd brightness(Eigen::Index(target_.receivers.size()));
  for (Eigen::Index i = 0; i < brightness.size(); ++i) brightness[i] = double((i * 7919) % 1009);
  const ReceiverDraw draw = draw_brightest_and_evenly(target_, brightness, kMost);
  expect_sound(draw);
  double least_sure = 1e9, most_left = 0;
  std::size_t sure = 0;
  std::vector<char> drawn(target_.receivers.size(), 0);
  for (std::size_t k = 0; k < kMost; ++k) {
    if (draw.probability[k] < 1) continue;
    ++sure;
    drawn[draw.chosen[k]] = 1;
    least_sure = std::min(least_sure, brightness[Eigen::Index(draw.chosen[k])]);
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i] == 0 && target_.weight[i] > 0) most_left = std::max(most_left, brightness[Eigen::Index(i)]);
  }
  EXPECT_EQ(sure, kMost / 2);
  EXPECT_GE(least_sure, most_left);
}

TEST_F(Draws, TakeAllWhereThereAreNoMore) {
  const Eigen::VectorXd brightness = Eigen::VectorXd::Ones(Eigen::Index(target_.receivers.size()));
  for (const ReceiverDraw& draw : {draw_evenly(target_, weighted_), draw_evenly(target_, 2 * weighted_),
                                   draw_brightest_and_evenly(target_, brightness, weighted_)}) {
    EXPECT_EQ(draw.chosen.size(), weighted_);
    for (const double probability : draw.probability) EXPECT_EQ(probability, 1);
  }
}

}  // namespace
}  // namespace chiaro::inverse
