#include "inverse/numerics/watershed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace chiaro::inverse::numerics {
namespace {

using Counts = std::array<int, 3>;

ScalarField make_field(const Counts& counts, const std::function<double(int, int, int)>& value) {
  ScalarField field{counts, {}};
  for (int z = 0; z < counts[2]; ++z) {
    for (int y = 0; y < counts[1]; ++y) {
      for (int x = 0; x < counts[0]; ++x) field.values.push_back(value(x, y, z));
    }
  }
  return field;
}

ScalarField row(std::vector<double> values) { return {{int(values.size()), 1, 1}, std::move(values)}; }

double gaussian(double x, double y, double z, const std::array<double, 3>& centre) {
  const double dx = x - centre[0], dy = y - centre[1], dz = z - centre[2];
  return std::exp(-(dx * dx + dy * dy + dz * dz) / 8);
}

// The highest of a node and its neighbours, by the definition.
int uphill(const ScalarField& field, int node) {
  const auto [nx, ny, nz] = field.counts;
  const int x = node % nx, y = node / nx % ny, z = node / nx / ny;
  int best = node;
  for (int other = 0; other < nx * ny * nz; ++other) {
    const int dx = other % nx - x, dy = other / nx % ny - y, dz = other / nx / ny - z;
    if (std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) > 1) continue;
    if (field.values[other] > field.values[best]) best = other;
  }
  return best;
}

std::vector<int> steepest_ascent(const ScalarField& field) {
  std::vector<int> peak_of(field.values.size(), -1), peaks;
  for (int node = 0; node < int(field.values.size()); ++node) {
    if (!(field.values[node] > 0)) continue;
    int peak = node;
    for (int next = uphill(field, peak); next != peak; next = uphill(field, peak)) peak = next;
    peak_of[node] = peak;
    if (peak == node) peaks.push_back(node);
  }
  std::sort(peaks.begin(), peaks.end(), [&](int a, int b) { return field.values[a] > field.values[b]; });
  for (int& label : peak_of) {
    if (label >= 0) label = int(std::find(peaks.begin(), peaks.end(), label) - peaks.begin());
  }
  return peak_of;
}

ScalarField random_field(const Counts& counts, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-0.5, 1);
  return make_field(counts, [&](int, int, int) { return value(random); });
}

TEST(Watershed, TwoGaussiansAreTwoBasins) {
  const std::array<double, 3> a{3, 3, 3}, b{9, 3, 3};
  const ScalarField field =
      make_field({13, 7, 7}, [&](int x, int y, int z) { return gaussian(x, y, z, a) + 0.8 * gaussian(x, y, z, b); });
  const std::vector<int> label = watershed(field);
  const auto at = [&](int x, int y, int z) { return label[(z * 7 + y) * 13 + x]; };
  EXPECT_EQ(at(3, 3, 3), 0);  // the higher maximum comes first
  EXPECT_EQ(at(9, 3, 3), 1);
  EXPECT_EQ(at(0, 0, 0), 0);
  EXPECT_EQ(at(12, 6, 6), 1);
  EXPECT_EQ(*std::max_element(label.begin(), label.end()), 1);
}

TEST(Watershed, EqualsSteepestAscentOnGenericFields) {
  const Counts shapes[] = {{9, 8, 7},  {1, 12, 9}, {15, 1, 6}, {11, 10, 1},
                           {1, 1, 40}, {40, 1, 1}, {2, 2, 2},  {1, 1, 1}};
  unsigned seed = 0;
  for (const Counts& shape : shapes) {
    for (int trial = 0; trial < 5; ++trial) {
      const ScalarField field = random_field(shape, ++seed);
      EXPECT_EQ(watershed(field), steepest_ascent(field)) << "seed " << seed;
    }
  }
}

TEST(Watershed, EveryPositiveNodeHasALabelAndNoOther) {
  for (unsigned seed = 50; seed < 60; ++seed) {
    ScalarField field = random_field({8, 9, 5}, seed);
    for (double& value : field.values) value = std::round(4 * value) / 4;  // plateaus and ties in plenty
    const std::vector<int> label = watershed(field);
    for (std::size_t i = 0; i < label.size(); ++i) EXPECT_EQ(label[i] >= 0, field.values[i] > 0);
  }
}

TEST(Watershed, BasinsAreConnectedAndHoldOneMaximumEach) {
  ScalarField field = random_field({10, 10, 1}, 70);
  for (double& value : field.values) value = std::round(5 * value) / 5;
  const std::vector<int> label = watershed(field);
  const int basins = *std::max_element(label.begin(), label.end()) + 1;
  ASSERT_GT(basins, 1);
  double last = 1e9;
  for (int basin = 0; basin < basins; ++basin) {
    ScalarField alone = field;
    double highest = 0;
    for (std::size_t i = 0; i < label.size(); ++i) {
      if (label[i] != basin) alone.values[i] = 0;
      highest = std::max(highest, alone.values[i]);
    }
    const std::vector<int> again = watershed(alone);
    EXPECT_EQ(*std::max_element(again.begin(), again.end()), 0) << "basin " << basin;
    EXPECT_LE(highest, last);
    last = highest;
  }
}

TEST(Watershed, APlateauIsOneBasin) {
  EXPECT_EQ(watershed(row({1, 2, 2, 2, 1, 0, 2})), (std::vector<int>{0, 0, 0, 0, 0, -1, 1}));
  const ScalarField flat = make_field({4, 3, 2}, [](int, int, int) { return 1.0; });
  EXPECT_EQ(watershed(flat), std::vector<int>(24, 0));
}

TEST(Watershed, APlateauBelowTwoMaximaIsSplitInTheMiddle) {
  EXPECT_EQ(watershed(row({4, 1, 1, 1, 1, 3})), (std::vector<int>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(watershed(row({3, 1, 1, 1, 4})), (std::vector<int>{1, 1, 0, 0, 0}));  // the middle: to the higher maximum
}

TEST(Watershed, EqualMaximaAreNumberedByNode) {
  EXPECT_EQ(watershed(row({1, 5, 1, 5, 1})), (std::vector<int>{0, 0, 0, 1, 1}));
}

TEST(Watershed, DiagonalNeighboursAreConnected) {
  const ScalarField field = make_field({3, 3, 3}, [](int x, int y, int z) { return x == y && y == z ? 1.0 : 0.0; });
  const std::vector<int> label = watershed(field);
  EXPECT_EQ(label[0], 0);
  EXPECT_EQ(label[13], 0);
  EXPECT_EQ(label[26], 0);
}

TEST(Watershed, ValuesThatAreNotPositiveBelongToNone) {
  EXPECT_EQ(watershed(row({0, -1, NAN, 2, 0})), (std::vector<int>{-1, -1, -1, 0, -1}));
  EXPECT_EQ(watershed(row({0, 0})), (std::vector<int>{-1, -1}));
}

TEST(Watershed, EmptyAndMisshapenFields) {
  EXPECT_TRUE(watershed({}).empty());
  EXPECT_TRUE(watershed({{0, 5, 5}, {}}).empty());
  EXPECT_THROW(watershed({{2, 2, 2}, {1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW(watershed({{-1, -1, 2}, {1, 2}}), std::invalid_argument);
}

}  // namespace
}  // namespace chiaro::inverse::numerics
