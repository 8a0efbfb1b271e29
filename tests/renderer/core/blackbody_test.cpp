#include "renderer/core/blackbody.h"

#include <gtest/gtest.h>

#include <cmath>

namespace chiaro::renderer {
namespace {

struct Xyz {
  double x = 0, y = 0, z = 0;
};

// One lobe of the fits to the CIE 1931 colour matching functions.
double lobe(double nm, double middle, double below, double above) {
  const double t = (nm - middle) * (nm < middle ? below : above);
  return std::exp(-0.5 * t * t);
}

// Planck's law under the matching functions as fitted by Wyman, Sloan, Shirley, Simple Analytic Approximations to the
// CIE XYZ Color Matching Functions, 2013.
Xyz planckian(double kelvin) {
  Xyz sum;
  for (double nm = 360; nm <= 830; nm += 1) {
    const double power = std::pow(nm / 560, -5) / std::expm1(1.4387769e7 / (nm * kelvin));
    sum.x += power * (1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442, 0.0624, 0.0374) -
                      0.065 * lobe(nm, 501.1, 0.0490, 0.0382));
    sum.y += power * (0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322));
    sum.z += power * (1.217 * lobe(nm, 437, 0.0845, 0.0278) + 0.681 * lobe(nm, 459, 0.0385, 0.0725));
  }
  return sum;
}

TEST(Blackbody, IsPlancksLawUnderTheMatchingFunctions) {
  for (const double kelvin : {2000.0, 2700.0, 3200.0, 4000.0, 5000.0, 6500.0, 10000.0, 20000.0}) {
    const Xyz p = planckian(kelvin);
    const double r = 3.2409699 * p.x - 1.5373832 * p.y - 0.4986108 * p.z;
    const double g = -0.9692436 * p.x + 1.8759675 * p.y + 0.0415551 * p.z;
    const double b = 0.0556301 * p.x - 0.2039770 * p.y + 1.0569715 * p.z;
    const double most = std::max({r, g, b});
    const Vec3f color = blackbody_color(kelvin);
    EXPECT_NEAR(color.x, r / most, 0.02) << kelvin;
    EXPECT_NEAR(color.y, g / most, 0.02) << kelvin;
    EXPECT_NEAR(color.z, b / most, 0.02) << kelvin;
  }
}

TEST(Blackbody, IsBrightestAtOneAndNeverNegative) {
  for (double kelvin = kLeastKelvin; kelvin < kMostKelvin; kelvin *= 1.03) {
    const Vec3f color = blackbody_color(kelvin);
    EXPECT_EQ(max_component(color), 1.0F);
    EXPECT_GE(min_component(color), 0.0F);
  }
}

}  // namespace
}  // namespace chiaro::renderer
