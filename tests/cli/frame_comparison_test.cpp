#include "cli/frame_comparison.h"

#include <limits>

#include <gtest/gtest.h>

#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

ComparedFrames display_pictures() {
  ComparedFrames frames;
  frames.a = frames.b = renderer::make_image(8, 8, {"R", "G", "B"});
  frames.a.at(1, 1)[0] = 0.5F;
  return frames;
}

TEST(CliFrameComparison, RegionsHaveCornersAndMayHaveNames) {
  const NamedRegion named = parse_region("my face=1,2,30,40");
  EXPECT_EQ(named.name, "my face");
  EXPECT_EQ(named.pixels.x1, 30);
  EXPECT_EQ(parse_region("0,0,1,2").name, "0,0,1,2");
  for (const char* text : {"", "a=", "1,2,3", "1,2,3,4,5", "0,0,0,4", "4,0,2,4", "-1,0,2,4", "0,0,1.5,4", "=0,0,1,1"}) {
    EXPECT_THROW(parse_region(text), UsageError) << text;
  }
}

TEST(CliFrameComparison, DisplayPicturesPeakAtWhite) {
  const FrameComparison found = compare_frames(display_pictures(), {}, {});
  EXPECT_NEAR(found.whole.image.psnr, 10 * std::log10(8 * 8 * 3 / 0.25), 1e-9);
  EXPECT_GT(found.whole.flip.value_or(0), 0);
  EXPECT_FALSE(found.whole.flip_hdr.has_value());
}

TEST(CliFrameComparison, BadPixelsHaveNoFlip) {
  ComparedFrames frames = display_pictures();
  frames.a.at(1, 1)[2] = std::numeric_limits<float>::quiet_NaN();
  const FrameComparison found = compare_frames(frames, {}, {});
  EXPECT_TRUE(std::isnan(*found.panels.flip->at(1, 1)));
  EXPECT_EQ(found.whole.flip.value(), 0) << "neither of themselves nor of their neighbours";
  frames.scene_linear = true;
  EXPECT_EQ(compare_frames(frames, {}, {}).whole.flip_hdr.value(), 0);
}

TEST(CliFrameComparison, RegionsAreJudgedApart) {
  FrameComparisonOptions options;
  options.regions = {{"dot", {0, 0, 2, 2}}, {"rest", {6, 6, 8, 8}}};
  const FrameComparison found = compare_frames(display_pictures(), options, {});
  EXPECT_GT(found.of_regions[0].flip.value(), found.of_regions[1].flip.value());
  EXPECT_EQ(found.of_regions[1].image.rmse, 0);
}

TEST(CliFrameComparison, FlipIsLeftOutOnRequest) {
  FrameComparisonOptions options;
  options.no_flip = true;
  EXPECT_FALSE(compare_frames(display_pictures(), options, {}).whole.flip.has_value());
}

TEST(CliFrameComparison, FiguresOfLinearFramesAloneNeedNoView) {
  ComparedFrames frames = display_pictures();
  frames.scene_linear = true;
  FrameComparisonOptions options;
  options.view.config = "/nowhere/config.ocio";
  EXPECT_ANY_THROW(compare_frames(frames, options, {}));
  options.no_flip = true;
  EXPECT_ANY_THROW(compare_frames(frames, options, {})) << "the picture needs one";
  options.picture = false;
  EXPECT_GT(compare_frames(frames, options, {}).whole.image.rmse, 0);
}

}  // namespace
}  // namespace chiaro::cli
