#include "inverse/solve/cross_shadow_edges.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"

namespace chiaro::inverse {
namespace {

using namespace tests;

struct Crossing {
  bool any_moved;
  LightEstimates lights;
  double error_before, error_after;
};

Crossing cross(const PaintedCorner& corner, const DirectProblem& problem, const LightEstimates& from) {
  const SettlingBench bench{problem.response(), problem.observations()};
  const std::vector<Column> none(from.size(), Column::Zero(problem.observations().wanted.rows(), 3));
  const auto error = [&](const LightEstimates& lights) {
    return relative_error(problem.observations(), bench.illumination(none, lights));
  };
  Crossing crossing{false, from, error(from), 0};
  crossing.any_moved = cross_shadow_edges(corner.tracer(), bench, none, crossing.lights);
  crossing.error_after = error(crossing.lights);
  return crossing;
}

TEST(CrossShadowEdges, LightsLookAroundWhereReceiversAreLitOrHiddenWrongly) {
  const PaintedCorner corner;
  const LightEstimates known = known_lights(2);
  const DirectProblem problem(known, 1000);
  LightEstimates beside = known;
  beside[0].position += 0.0015 * corner.diagonal() * Vector3d(0.6, -0.64, 0.48);
  const Crossing crossing = cross(corner, problem, beside);
  ASSERT_TRUE(crossing.any_moved);
  EXPECT_LT(crossing.error_after, 0.1 * crossing.error_before);
  EXPECT_LT(farthest_from(known, positions_of(crossing.lights)), 0.1 * farthest_from(known, positions_of(beside)));
  for (std::size_t j = 0; j < known.size(); ++j)
    EXPECT_TRUE((crossing.lights[j].intensity == known[j].intensity).all());
}

TEST(CrossShadowEdges, LightsInTheirPlacesStay) {
  const PaintedCorner corner;
  const LightEstimates known = known_lights(2);
  const DirectProblem problem(known, 1000);
  EXPECT_FALSE(cross(corner, problem, known).any_moved);
}

}  // namespace
}  // namespace chiaro::inverse
