#include "inverse/transport/sparse_transport.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

using renderer::Sampler;
using Rows = std::vector<std::vector<SparseTransport::Entry>>;

constexpr std::uint32_t kRows = 1300, kColumns = 70;

// Rows of 0 to 39 entries, columns repeated and in no order.
Rows random_rows() {
  Rows rows(kRows);
  for (std::uint32_t r = 0; r < kRows; ++r) {
    for (std::uint32_t k = 0; k < r % 40; ++k) {
      Sampler sampler(1, r, k);
      const auto column = std::uint32_t(sampler.next_1d() * float(kColumns));
      const renderer::Vec2f xy = sampler.next_2d();
      rows[r].push_back({column, {xy.x, xy.y, sampler.next_1d()}});
    }
  }
  return rows;
}

TEST(SparseTransport, MultipliesLikeItsDenseForm) {
  const Rows rows = random_rows();
  std::vector<LightBlock> in(kColumns), out(kRows);
  for (std::uint32_t i = 0; i < kColumns; ++i) {
    Sampler sampler(2, i, 0);
    for (auto& channel : in[i].channel) {
      for (float& v : channel) v = sampler.next_1d();
    }
  }
  multiply(SparseTransport::from_rows(Rows(rows)), in, out);
  for (std::uint32_t r = 0; r < kRows; ++r) {
    double dense[kColumns][3] = {};
    for (const auto& entry : rows[r]) {
      for (int c = 0; c < 3; ++c) dense[entry.column][c] += double(entry.weight[c]);
    }
    for (int c = 0; c < 3; ++c) {
      for (int l = 0; l < kLightBlock; ++l) {
        double expected = 0;
        for (std::uint32_t i = 0; i < kColumns; ++i) expected += dense[i][c] * double(in[i].channel[c][l]);
        ASSERT_NEAR(out[r].channel[c][l], expected, 1e-5 * expected);
      }
    }
  }
}

TEST(SparseTransport, AddsUpEntriesOfOneColumn) {
  const SparseTransport matrix = SparseTransport::from_rows({{{3, {1, 2, 3}}, {1, {1, 1, 1}}, {3, {10, 20, 30}}}, {}});
  EXPECT_EQ(matrix.row_count(), 2U);
  EXPECT_EQ(matrix.entry_count(), 2U);
  ASSERT_EQ(matrix.row(0).size(), 2U);
  EXPECT_EQ(matrix.row(0)[0].column, 1U);
  EXPECT_EQ(matrix.row(0)[1].column, 3U);
  EXPECT_EQ(matrix.row(0)[1].weight, (renderer::Vec3f{11, 22, 33}));
  EXPECT_TRUE(matrix.row(1).empty());
}

TEST(SparseTransport, TransposedSwapsRowsAndColumns) {
  const Rows rows = random_rows();
  const SparseTransport matrix = SparseTransport::from_rows(Rows(rows)), transposed = matrix.transposed(kColumns);
  ASSERT_EQ(transposed.row_count(), std::size_t(kColumns));
  EXPECT_EQ(transposed.entry_count(), matrix.entry_count());
  for (std::uint32_t column = 0; column < kColumns; ++column) {
    for (const auto& entry : transposed.row(column)) {
      const auto row = matrix.row(entry.column);
      const auto same = std::find_if(row.begin(), row.end(), [&](const auto& e) { return e.column == column; });
      ASSERT_NE(same, row.end());
      EXPECT_EQ(same->weight, entry.weight);
    }
  }
}

TEST(SparseTransport, OfNoRowsIsEmpty) {
  const SparseTransport matrix = SparseTransport::from_rows({});
  EXPECT_EQ(matrix.row_count(), 0U);
  std::vector<LightBlock> none;
  multiply(matrix, none, none);
}

}  // namespace
}  // namespace chiaro::inverse
