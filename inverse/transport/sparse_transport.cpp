#include "inverse/transport/sparse_transport.h"

#include <algorithm>

#include "renderer/core/control.h"
#include "renderer/core/cpu_dispatch.h"

namespace chiaro::inverse {
namespace {

using renderer::Vec3f;

constexpr std::size_t kAhead = 6;  // entries, of which the columns are fetched before they are needed

template <class Lanes>
[[gnu::always_inline]] inline void add_product(const SparseTransport::Entry& entry, const Lanes* in, Lanes& sum) {
  const Lanes& x = in[entry.column];
  for (int l = 0; l < Lanes::kLanes; ++l) sum.channel[0][l] += entry.weight.x * x.channel[0][l];
  for (int l = 0; l < Lanes::kLanes; ++l) sum.channel[1][l] += entry.weight.y * x.channel[1][l];
  for (int l = 0; l < Lanes::kLanes; ++l) sum.channel[2][l] += entry.weight.z * x.channel[2][l];
}

[[gnu::always_inline]] inline void multiply_any_row(const SparseTransport::Entry* entry,
                                                    const SparseTransport::Entry* end, const LightBlock* in,
                                                    LightBlock* result) {
  LightBlock sum;
  for (; entry != end; ++entry) {
    // Columns are all over the place; the rows after this one follow in memory.
    const auto* ahead = reinterpret_cast<const char*>(&in[entry[kAhead].column]);
    for (std::size_t line = 0; line < sizeof(LightBlock); line += 64) __builtin_prefetch(ahead + line);
    add_product(*entry, in, sum);
  }
  *result = sum;
}

template <class Lanes>
[[gnu::always_inline]] inline void multiply_any_row(const SparseTransport::Entry* entry,
                                                    const SparseTransport::Entry* end, const Lanes* in, Lanes* result) {
  // Two sums at once, as each would wait for its last addition.
  Lanes even, odd;
  for (; end - entry >= 2; entry += 2) {
    add_product(entry[0], in, even);
    add_product(entry[1], in, odd);
  }
  if (entry != end) add_product(*entry, in, even);
  for (int c = 0; c < 3; ++c) {
    for (int l = 0; l < Lanes::kLanes; ++l) result->channel[c][l] = even.channel[c][l] + odd.channel[c][l];
  }
}

CHIARO_DISPATCH void multiply_row(const SparseTransport::Entry* entry, const SparseTransport::Entry* end,
                                  const LightBlock* in, LightBlock* result) {
  multiply_any_row(entry, end, in, result);
}

CHIARO_DISPATCH void multiply_row(const SparseTransport::Entry* entry, const SparseTransport::Entry* end,
                                  const LightQuad* in, LightQuad* result) {
  multiply_any_row(entry, end, in, result);
}

CHIARO_DISPATCH void multiply_row(const SparseTransport::Entry* entry, const SparseTransport::Entry* end,
                                  const OneLight* in, OneLight* result) {
  multiply_any_row(entry, end, in, result);
}

template <class Lanes>
void multiply_each(const SparseTransport& matrix, std::size_t first, std::span<const Lanes> in,
                   std::span<Lanes> result) {
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto row = matrix.row(first + i);
    multiply_row(row.data(), row.data() + row.size(), in.data(), &result[i]);
  }
}

template <class Lanes>
void multiply_all(const SparseTransport& matrix, std::span<const Lanes> in, std::span<Lanes> result) {
  constexpr std::size_t kRows = 512;
  renderer::parallel_for((result.size() + kRows - 1) / kRows, [&](std::size_t chunk) {
    const std::size_t first = chunk * kRows;
    multiply_each(matrix, first, in, result.subspan(first, std::min(kRows, result.size() - first)));
  });
}

}  // namespace

SparseTransport SparseTransport::from_rows(std::vector<std::vector<Entry>>&& rows) {
  SparseTransport matrix;
  for (std::vector<Entry>& row : rows) {
    std::stable_sort(row.begin(), row.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
    const std::size_t first = matrix.entries_.size();
    for (const Entry& entry : row) {
      if (matrix.entries_.size() > first && matrix.entries_.back().column == entry.column) {
        matrix.entries_.back().weight += entry.weight;
      } else {
        matrix.entries_.push_back(entry);
      }
    }
    matrix.row_start_.push_back(matrix.entries_.size());
    std::vector<Entry>().swap(row);
  }
  matrix.entries_.resize(matrix.entries_.size() + kAhead);  // no entries, only read ahead
  return matrix;
}

SparseTransport SparseTransport::transposed(std::size_t columns) const {
  std::vector<std::vector<Entry>> rows(columns);
  for (std::size_t i = 0; i < row_count(); ++i) {
    for (const Entry& entry : row(i)) rows[entry.column].push_back({std::uint32_t(i), entry.weight});
  }
  return from_rows(std::move(rows));
}

void multiply(const SparseTransport& matrix, std::span<const LightBlock> in, std::span<LightBlock> result) {
  multiply_all(matrix, in, result);
}

void multiply(const SparseTransport& matrix, std::span<const LightQuad> in, std::span<LightQuad> result) {
  multiply_all(matrix, in, result);
}

void multiply(const SparseTransport& matrix, std::span<const OneLight> in, std::span<OneLight> result) {
  multiply_all(matrix, in, result);
}

void multiply_rows(const SparseTransport& matrix, std::size_t first, std::span<const LightBlock> in,
                   std::span<LightBlock> result) {
  multiply_each(matrix, first, in, result);
}

void multiply_rows(const SparseTransport& matrix, std::size_t first, std::span<const LightQuad> in,
                   std::span<LightQuad> result) {
  multiply_each(matrix, first, in, result);
}

void multiply_rows(const SparseTransport& matrix, std::size_t first, std::span<const OneLight> in,
                   std::span<OneLight> result) {
  multiply_each(matrix, first, in, result);
}

}  // namespace chiaro::inverse
