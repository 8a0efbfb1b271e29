#include "renderer/image/known_primaries.h"

#include <algorithm>
#include <cmath>

namespace chiaro::renderer {
namespace {

using Matrix = Rec709FromSpace;
using Vector = std::array<double, 3>;
using Chromaticities = std::array<float, 8>;

constexpr Chromaticities kRec709{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
constexpr Chromaticities kKnown[] = {
    kRec709,
    {0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F, 0.3127F, 0.3290F},                    // Rec.2020
    {0.680F, 0.320F, 0.265F, 0.690F, 0.150F, 0.060F, 0.3127F, 0.3290F},                    // P3, D65
    {0.64F, 0.33F, 0.21F, 0.71F, 0.15F, 0.06F, 0.3127F, 0.3290F},                          // Adobe RGB (1998)
    {0.713F, 0.293F, 0.165F, 0.830F, 0.128F, 0.044F, 0.32168F, 0.33767F},                  // ACES AP1 (ACEScg)
    {0.7347F, 0.2653F, 0.0F, 1.0F, 0.0001F, -0.0770F, 0.32168F, 0.33767F},                 // ACES AP0 (ACES2065-1)
    {0.734699F, 0.265301F, 0.159597F, 0.840403F, 0.036598F, 0.000105F, 0.3457F, 0.3585F},  // ROMM (ProPhoto)
};

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) product[i][j] += a[i][k] * b[k][j];
    }
  }
  return product;
}

Vector multiply(const Matrix& a, const Vector& v) {
  Vector product{};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) product[i] += a[i][k] * v[k];
  }
  return product;
}

Matrix inverse(const Matrix& a) {
  const auto cofactor = [&](int i, int j) {
    return a[(i + 1) % 3][(j + 1) % 3] * a[(i + 2) % 3][(j + 2) % 3] -
           a[(i + 1) % 3][(j + 2) % 3] * a[(i + 2) % 3][(j + 1) % 3];
  };
  const double determinant = a[0][0] * cofactor(0, 0) + a[0][1] * cofactor(0, 1) + a[0][2] * cofactor(0, 2);
  Matrix result{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[j][i] = cofactor(i, j) / determinant;
  }
  return result;
}

Matrix diagonal(const Vector& v) { return {{{v[0], 0, 0}, {0, v[1], 0}, {0, 0, v[2]}}}; }

Vector xyz_of(double x, double y) { return {x / y, 1, (1 - x - y) / y}; }

Vector white_of(const Chromaticities& c) { return xyz_of(c[6], c[7]); }

// SMPTE RP 177: primaries scaled so that (1, 1, 1) is white.
Matrix xyz_from_rgb(const Chromaticities& c) {
  Matrix primaries{};
  for (int i = 0; i < 3; ++i) {
    const double x = c[2 * i], y = c[2 * i + 1];
    primaries[0][i] = x;
    primaries[1][i] = y;
    primaries[2][i] = 1 - x - y;
  }
  return multiply(primaries, diagonal(multiply(inverse(primaries), white_of(c))));
}

// Source: Lam, Metamerism and Colour Constancy, 1985 (the Bradford transform).
Matrix bradford(const Vector& from_white, const Vector& to_white) {
  constexpr Matrix kCone{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
  const Vector from = multiply(kCone, from_white), to = multiply(kCone, to_white);
  return multiply(inverse(kCone), multiply(diagonal({to[0] / from[0], to[1] / from[1], to[2] / from[2]}), kCone));
}

Matrix rec709_from(const Chromaticities& c) {
  const Matrix adapted = multiply(bradford(white_of(c), white_of(kRec709)), xyz_from_rgb(c));
  return multiply(inverse(xyz_from_rgb(kRec709)), adapted);
}

double largest_difference(const Matrix& a, const Matrix& b) {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
  }
  return largest;
}

}  // namespace

std::optional<std::array<float, 8>> known_chromaticities(const Rec709FromSpace& matrix) {
  for (const Chromaticities& c : kKnown) {
    if (largest_difference(matrix, rec709_from(c)) <= 2e-3) return c;
  }
  return std::nullopt;
}

Rec709FromSpace rec709_from_chromaticities(const std::array<float, 8>& chromaticities) {
  return rec709_from(chromaticities);
}

}  // namespace chiaro::renderer
