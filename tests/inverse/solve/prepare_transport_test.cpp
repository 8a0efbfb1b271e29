#include "inverse/solve/prepare_transport.h"

#include <gtest/gtest.h>

#include "tests/inverse/solve/painted_corner.h"
#include "tests/support/save_transport_cache.h"
#include "tests/support/temporary_folder.h"

namespace chiaro::inverse {
namespace {

using tests::bake_settings;
using tests::known_lights;
using tests::PaintedCorner;

// Below a ball the floor is dark, and bright half a metre farther on, where a picture shows it.
TEST(PrepareTransport, MovedSamplesSeeWhatABakeOfThemFinds) {
  const PaintedCorner corner(0.4F);
  Target target = corner.target(known_lights(1), 0);
  const test::TemporaryFolder folder;
  SolveProblem problem{corner.tracer(), target, {}, {}, bake_settings(0), {}};
  problem.grid.counts = {5, 4, 5};
  problem.cache_file = folder.path() / "cache.exr";
  const LightGrid grid = make_light_grid(corner.tracer(), problem.grid);
  const TransportCache baked = bake(corner.tracer(), corner.receivers(), grid, bake_settings(0)).cache;
  save_transport_cache(baked, *problem.cache_file);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < corner.receivers().size(); i += 3) chosen.push_back(i);
  const auto expected = [&] {
    return bake(corner.tracer(), select_receivers(target.receivers, chosen), grid, bake_settings(0)).cache.visibility;
  };
  const std::vector<std::uint8_t> unmoved = expected();
  EXPECT_EQ(prepare_transport(problem, chosen, {}).cache.visibility, unmoved);

  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    renderer::SurfaceSample& at = target.receivers.samples[i];
    if (at.normal.y > 0.99F) at.position = at.position + Vec3f{0.5F, 0, 0};
  }
  target.receivers.samples_moved = true;
  EXPECT_NE(expected(), unmoved);
  EXPECT_EQ(prepare_transport(problem, chosen, {}).cache.visibility, expected());
}

}  // namespace
}  // namespace chiaro::inverse
