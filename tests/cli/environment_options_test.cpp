#include "cli/environment_options.h"

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "tests/support/environments.h"

namespace chiaro::cli {
namespace {

// Pixels and an intensity that are both allowed may come to more than may be, and to infinity.
TEST(CliEnvironmentOptions, PixelsTimesIntensityAreNoBrighterThanMayBe) {
  const renderer::Lights bright{test::environment(test::environment_map(2, 1, [](int x, int) {
    return renderer::Vec3f{1, x == 1 ? 1e20F : 0, 1};
  }))};
  EnvironmentOptions options;
  std::vector<std::string> warnings;
  options.intensity = 9e3F;
  EXPECT_EQ(with_environment(bright, options, warnings).size(), 1U);
  options.intensity = 1.1e4F;
  EXPECT_THROW(with_environment(bright, options, warnings), renderer::Error);
}

}  // namespace
}  // namespace chiaro::cli
