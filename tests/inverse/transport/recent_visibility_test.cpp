#include "inverse/transport/recent_visibility.h"

#include <cmath>

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

Visibility visibility_of(double part, std::size_t receivers) {
  return std::make_shared<const std::vector<double>>(receivers, part);
}

TEST(RecentVisibility, KnowsThisVeryPlaceAlone) {
  RecentVisibility recent(3);
  recent.add({1, 2, 3}, visibility_of(0.5, 3));
  const Visibility found = recent.find({1, 2, 3});
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(*found, std::vector<double>(3, 0.5));
  EXPECT_EQ(recent.find({1, 2, std::nextafter(3.0F, 4.0F)}), nullptr);
}

TEST(RecentVisibility, ForgetsWhatWasNotAskedForLongest) {
  constexpr std::size_t kReceivers = 1 << 20;  // of 8 MiB a place: four fit
  RecentVisibility recent(kReceivers);
  const Visibility any = visibility_of(1, 1);
  for (int k = 0; k < 4; ++k) recent.add({float(k), 0, 0}, any);
  EXPECT_NE(recent.find({0, 0, 0}), nullptr);
  recent.add({4, 0, 0}, any);
  EXPECT_EQ(recent.find({1, 0, 0}), nullptr);
  for (const float x : {0, 2, 3, 4}) EXPECT_NE(recent.find({x, 0, 0}), nullptr) << x;
}

}  // namespace
}  // namespace chiaro::inverse
