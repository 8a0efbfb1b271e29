#include "inverse/numerics/growing_cholesky.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

namespace chiaro::inverse::numerics {
namespace {

Eigen::MatrixXd random_gram(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(size + 5, size, [&] { return normal(random); });
  return a.transpose() * a;
}

Eigen::VectorXd products(const Eigen::MatrixXd& gram, const std::vector<int>& members, int column) {
  Eigen::VectorXd values(Eigen::Index(members.size()));
  for (int i = 0; i < values.size(); ++i) values[i] = gram(members[i], column);
  return values;
}

TEST(GrowingCholesky, SolvesLikeAFreshFactorisationAfterRowsCameAndWent) {
  const int size = 40;
  const Eigen::MatrixXd gram = random_gram(size, 1);
  std::mt19937 random(2);
  GrowingCholesky factor;
  std::vector<int> members;
  for (int round = 0; round < 500; ++round) {
    const int index = std::uniform_int_distribution<int>(0, size - 1)(random);
    const auto place = std::find(members.begin(), members.end(), index);
    if (place != members.end()) {
      factor.remove(int(place - members.begin()));
      members.erase(place);
    } else {
      factor.append(factor.make_row(products(gram, members, index), gram(index, index)));
      members.push_back(index);
    }
    ASSERT_EQ(factor.size(), int(members.size()));
  }
  ASSERT_GT(members.size(), 10U);
  const Eigen::MatrixXd part = gram(members, members);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(part.rows(), -1, 2);
  const Eigen::VectorXd expected = part.llt().solve(b);
  EXPECT_LE((factor.solve(b) - expected).norm(), 1e-9 * expected.norm());
}

TEST(GrowingCholesky, PivotOfADependentColumnIsZero) {
  GrowingCholesky factor;
  factor.append(factor.make_row({}, 4));
  const GrowingCholesky::Row row = factor.make_row(Eigen::VectorXd::Constant(1, 6.0), 9);  // 1.5 × the first column
  EXPECT_NEAR(row.pivot, 0, 1e-14);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
