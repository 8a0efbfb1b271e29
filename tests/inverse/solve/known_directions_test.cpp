#include "inverse/solve/known_directions.h"

#include <gtest/gtest.h>

namespace chiaro::inverse {
namespace {

using Eigen::MatrixXd;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

KnownDirections of_columns(const MatrixXd& columns) { return known_directions(columns.transpose() * columns); }

TEST(KnownDirections, ColumnsThatDifferAreKnown) {
  const KnownDirections known = of_columns((MatrixXd(3, 2) << 1, 0, 1, 100, 0, 100).finished());
  EXPECT_EQ(known.basis.cols(), 2);
  EXPECT_TRUE(known.knows(0) && known.knows(1));
  EXPECT_TRUE(pairs_known_by_sum(known, {0, 1}).empty());
}

TEST(KnownDirections, OfEqualColumnsTheSumAloneIsKnown) {
  const KnownDirections known = of_columns((MatrixXd(3, 4) << 1, 0, 1, 0, 2, 3, 2, 0, 3, 0, 3, 0).finished());
  EXPECT_FALSE(known.knows(0) || known.knows(2));
  EXPECT_TRUE(known.knows(1));
  EXPECT_FALSE(known.knows(3)) << "of nothing nothing is known";
  EXPECT_EQ(pairs_known_by_sum(known, {0, 1, 2, 3}), (Pairs{{0, 2}}));
  EXPECT_EQ(pairs_known_by_sum(of_columns(MatrixXd::Ones(4, 3)), {0, 1, 2}), (Pairs{{0, 1}, {0, 2}, {1, 2}}));
}

// One row: any of them may be anything, and so may their sum.
TEST(KnownDirections, OfProportionalColumnsNotEvenTheSumIsKnown) {
  const KnownDirections known = of_columns((MatrixXd(1, 2) << 1, 3).finished());
  EXPECT_FALSE(known.knows(0) || known.knows(1));
  EXPECT_TRUE(pairs_known_by_sum(known, {0, 1}).empty());
}

TEST(KnownDirections, WhatIsNoiseIsNotKnown) {
  const MatrixXd normal = (MatrixXd(2, 2) << 1, 0.99, 0.99, 1).finished();
  const auto all_but_small = [](double eigenvalue, const Eigen::VectorXd&) { return eigenvalue > 0.1; };
  EXPECT_TRUE(known_directions(normal).knows(0));
  const KnownDirections known = known_directions(normal, all_but_small);
  EXPECT_FALSE(known.knows(0));
  EXPECT_EQ(pairs_known_by_sum(known, {0, 1}), (Pairs{{0, 1}}));
}

}  // namespace
}  // namespace chiaro::inverse
