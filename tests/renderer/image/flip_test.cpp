#include "renderer/image/flip.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "renderer/image/hdr_flip.h"

namespace chiaro::renderer {
namespace {

Image constant(float r, float g, float b) {
  Image image = make_image(4, 3, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    image.pixels[i] = r;
    image.pixels[i + 1] = g;
    image.pixels[i + 2] = b;
  }
  return image;
}

float noise(int x, int y, int c) {
  std::uint32_t hash = std::uint32_t(x) * 73856093U ^ std::uint32_t(y) * 19349663U ^ std::uint32_t(c) * 83492791U;
  hash ^= hash >> 13;
  hash *= 0x5bd1e995U;
  hash ^= hash >> 15;
  return float(hash % 1000U) / 999.0F;
}

struct Pair {
  Image noisy = make_image(48, 32, {"R", "G", "B"}), clean = noisy;
};

// A chequerboard with gradients, and the same with noise; over twelve stops where it is scene-linear.
Pair chequerboards(bool scene_linear) {
  Pair pair;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) {
      for (int c = 0; c < 3; ++c) {
        float value = 0.8F * ((x / 8 + y / 8) % 2 ? 0.75F : 0.25F) + 0.2F * float(x) / 47;
        if (c == 1) value *= 0.5F + 0.5F * float(y) / 31;
        const float gain = scene_linear ? std::exp2(float(x) / 4 - 6) : 1;
        const float noisy = std::max(value + 0.2F * (noise(x, y, c) - 0.5F), 0.0F);
        pair.clean.at(x, y)[c] = gain * value;
        pair.noisy.at(x, y)[c] = scene_linear ? gain * noisy : std::min(noisy, 1.0F);
      }
    }
  }
  return pair;
}

double mean(const Image& image) {
  double sum = 0;
  for (const float value : image.pixels) sum += double(value);
  return sum / double(image.pixels.size());
}

float largest(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

// Without features and with nothing to filter only the difference of the colours is left, which is short enough to work
// out by hand from the paper.
TEST(Flip, OfConstantPicturesIsTheColoursDifference) {
  const auto difference = [](const Image& a, const Image& b) { return mean(flip_of_linear(a, b)); };
  EXPECT_NEAR(difference(constant(0, 0, 0), constant(1, 1, 1)), 0.96738, 2e-5);
  EXPECT_NEAR(difference(constant(0, 1, 0), constant(0, 0, 1)), 1, 2e-5);
  EXPECT_NEAR(difference(constant(0.2F, 0.2F, 0.2F), constant(0.25F, 0.25F, 0.25F)), 0.18340, 1e-4);
  EXPECT_NEAR(difference(constant(1, 0, 0), constant(0.9F, 0.1F, 0.1F)), 0.53554, 1e-4);
  EXPECT_EQ(difference(constant(0.3F, 0.2F, 0.1F), constant(0.3F, 0.2F, 0.1F)), 0);
}

// The values are those of the authors' program, version 1.7.
TEST(Flip, OfDisplayPicturesIsThePublishedOne) {
  const Pair pair = chequerboards(false);
  const Image near = flip(pair.noisy, pair.clean);
  EXPECT_NEAR(mean(near), 0.113533, 1e-4);
  EXPECT_NEAR(*near.at(5, 7), 0.094834, 2e-4);
  EXPECT_NEAR(*near.at(40, 30), 0.126858, 2e-4);
  EXPECT_NEAR(largest(near), 0.311457, 2e-4);
  const Image close = flip(pair.noisy, pair.clean, 20);
  EXPECT_NEAR(mean(close), 0.269826, 1e-4);
  EXPECT_NEAR(largest(close), 0.512576, 2e-4);
}

TEST(Flip, OfSceneLinearFramesIsThePublishedOne) {
  const Pair pair = chequerboards(true);
  const HdrFlip found = hdr_flip(pair.noisy, pair.clean);
  EXPECT_NEAR(found.start, -4.2051, 1e-3);
  EXPECT_NEAR(found.stop, 2.5399, 1e-3);
  EXPECT_EQ(found.exposures, 7);
  EXPECT_NEAR(mean(found.error), 0.096955, 1e-4);
  EXPECT_NEAR(*found.error.at(5, 7), 0.056934, 2e-4);
  EXPECT_NEAR(largest(found.error), 0.400880, 2e-4);
  EXPECT_NEAR(mean(hdr_flip(pair.noisy, pair.clean, 20).error), 0.234996, 1e-4);
}

TEST(Flip, OfSceneLinearFramesDoesNotDependOnTheirUnit) {
  Pair pair = chequerboards(true);
  const double before = mean(hdr_flip(pair.noisy, pair.clean).error);
  for (Image* image : {&pair.noisy, &pair.clean}) {
    for (float& value : image->pixels) value *= 1024;
  }
  EXPECT_NEAR(mean(hdr_flip(pair.noisy, pair.clean).error), before, 1e-5);
}

// Whose exposures are beyond floats.
TEST(Flip, OfReferencesThatAreNearlyBlackIsThatOfLightAndDark) {
  const Image white = constant(1, 1, 1), dim = constant(1e-40F, 1e-40F, 1e-40F);
  EXPECT_GT(mean(hdr_flip(white, dim).error), 0.1);
  EXPECT_EQ(mean(hdr_flip(dim, dim).error), 0);
}

TEST(Flip, OfBlackReferencesIsANumber) {
  const Image black = constant(0, 0, 0), grey = constant(1, 1, 1);
  EXPECT_EQ(mean(hdr_flip(black, black).error), 0);
  EXPECT_GT(mean(hdr_flip(grey, black).error), 0.5);
  Image spot = black;
  spot.pixels[0] = spot.pixels[1] = spot.pixels[2] = 4;
  const HdrFlip found = hdr_flip(black, spot);
  EXPECT_NEAR(found.start, found.stop, 1e-9) << "the median of what is not black";
  EXPECT_GT(mean(found.error), 0);
}

TEST(Flip, OfPixelsTooLargeForFeaturesIsANumber) {
  Image spot = constant(0.5F, 0.5F, 0.5F);
  const Image plain = spot;
  spot.pixels[0] = 1;
  for (const double pixels_per_degree : {1.0, 1.5, 2.0}) {
    EXPECT_EQ(mean(flip(plain, plain, pixels_per_degree)), 0) << pixels_per_degree;
    EXPECT_GT(mean(flip(spot, plain, pixels_per_degree)), 0) << pixels_per_degree;
  }
}

TEST(Flip, PixelsThatAreNotFiniteCountAsBlack) {
  Image odd = constant(1, 1, 1), black = odd;
  odd.pixels[0] = std::numeric_limits<float>::quiet_NaN();
  odd.pixels[1] = std::numeric_limits<float>::infinity();
  odd.pixels[2] = -1;
  black.pixels[0] = black.pixels[1] = black.pixels[2] = 0;
  EXPECT_EQ(hdr_flip(odd, constant(1, 1, 1)).error.pixels, hdr_flip(black, constant(1, 1, 1)).error.pixels);
}

}  // namespace
}  // namespace chiaro::renderer
