#include "inverse/solve/lights_beside_surfaces.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "inverse/transport/eigen_vectors.h"
#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

// At so many parts of the diagonal in front of a receiver of the floor's middle.
LightEstimate light_in_front(double parts) {
  const DirectProblem problem(known_lights(1));
  const Vector3d middle(2, 0, 2.5);
  const auto& receivers = problem.response().receivers();
  const auto nearest = std::min_element(receivers.begin(), receivers.end(), [&](const auto& a, const auto& b) {
    return (to_eigen(a.position) - middle).norm() < (to_eigen(b.position) - middle).norm();
  });
  return {to_eigen(nearest->position) + parts * problem.diagonal() * to_eigen(nearest->normal), {4, 8, 2}};
}

LightEstimates found_beside_surfaces(const LightEstimates& known) {
  const DirectProblem problem(known);
  return find_lights_beside_surfaces(problem.response(), problem.exact(), problem.observations(), 1);
}

TEST(LightsBesideSurfaces, AreFoundWhereTheyAre) {
  const LightEstimate known = light_in_front(0.01);
  const LightEstimates found = found_beside_surfaces({known});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].position - known.position).norm(), 0.002);
  EXPECT_TRUE(found[0].intensity.isApprox(known.intensity, 0.01));
}

// A few receivers hold nearly all of its light as well, but those know it less well than all receivers do.
TEST(LightsBesideSurfaces, AreNotThoseFartherAway) {
  for (const double parts : {0.022, 0.025, 0.03}) {
    EXPECT_TRUE(found_beside_surfaces({light_in_front(parts)}).empty()) << parts;
  }
}

TEST(LightsBesideSurfaces, AreNoneWhereNoneOutshinesTheRest) {
  const DirectProblem problem(known_lights(3));
  EXPECT_TRUE(find_lights_beside_surfaces(problem.response(), problem.exact(), problem.observations(), 10).empty());
}

TEST(LightsBesideSurfaces, AreNoneWhereAFewReceiversStandForMany) {
  const DirectProblem problem(known_lights(3));
  Observations drawn = problem.observations();
  for (const Eigen::Index i : {20, 110, 200}) {
    drawn.stands_for[i] = 1000;
    drawn.sqrt_weight[i] = std::sqrt(1000.0);
  }
  EXPECT_TRUE(find_lights_beside_surfaces(problem.response(), problem.exact(), drawn, 10).empty());
}

}  // namespace
}  // namespace chiaro::inverse
