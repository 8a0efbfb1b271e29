#include "renderer/core/color_temperature.h"

#include <gtest/gtest.h>

#include "renderer/core/blackbody.h"

namespace chiaro::renderer {
namespace {

TEST(ColorTemperature, OfABlackBodyIsItsOwn) {
  for (const double kelvin : {1900.0, 2700.0, 3000.0, 4100.0, 5000.0, 6500.0, 9000.0, 15000.0}) {
    const auto found = correlated_color_temperature(40 * blackbody_color(kelvin));
    if (kelvin < 2000) continue;  // red of Rec.709 clips what is warmer
    ASSERT_TRUE(found) << kelvin;
    EXPECT_NEAR(found->kelvin / kelvin, 1, 2e-3) << kelvin;
    EXPECT_NEAR(found->duv, 0, 2e-5) << kelvin;
  }
}

// D65, the white of Rec.709: 6504 K by CIE 15, which lies 0.0032 above the black bodies.
TEST(ColorTemperature, OfWhiteIsThatOfDaylight) {
  const auto white = correlated_color_temperature({1, 1, 1});
  ASSERT_TRUE(white);
  EXPECT_NEAR(white->kelvin, 6504, 15);
  EXPECT_NEAR(white->duv, 0.0032, 0.0002);
}

// Illuminant A as CIE 15 has it, x 0.44758, y 0.40745: 2856 K; in scene-linear Rec.709.
TEST(ColorTemperature, OfIlluminantA) {
  const double X = 0.44758 / 0.40745, Z = (1 - 0.44758 - 0.40745) / 0.40745;
  const Vec3f color{float(3.2409699 * X - 1.5373832 - 0.4986108 * Z), float(-0.9692436 * X + 1.8759675 + 0.0415551 * Z),
                    float(0.0556301 * X - 0.2039770 + 1.0569715 * Z)};
  const auto found = correlated_color_temperature(color);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->kelvin, 2856, 10);
  EXPECT_NEAR(found->duv, 0, 2e-4);
}

TEST(ColorTemperature, TellsGreenFromPurple) {
  EXPECT_GT(correlated_color_temperature({1, 1.05F, 1})->duv, correlated_color_temperature({1, 1, 1})->duv);
  EXPECT_LT(correlated_color_temperature({1, 0.9F, 1})->duv, 0);
}

TEST(ColorTemperature, IsNotOfColoursFarFromBlackBodies) {
  for (const Vec3f color : {Vec3f{0, 1, 0}, Vec3f{1, 0, 0}, Vec3f{0, 0, 1}, Vec3f{1, 0, 1}, Vec3f{}, Vec3f{-1, 1, 1}}) {
    EXPECT_FALSE(correlated_color_temperature(color));
  }
}

}  // namespace
}  // namespace chiaro::renderer
