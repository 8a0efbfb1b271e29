#include "inverse/transport/sparse_transport.h"

#include <algorithm>

#include "renderer/core/control.h"

// Wider vector units where the CPU has them, chosen at run time. Sanitizers cannot instrument the resolvers.
#if defined(__x86_64__) && !defined(CHIARO_SANITIZED)
#define CHIARO_DISPATCH __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CHIARO_DISPATCH
#endif

namespace chiaro::inverse {
namespace {

using renderer::Vec3f;

constexpr std::size_t kAhead = 6;  // entries, of which the columns are fetched before they are needed

CHIARO_DISPATCH void multiply_row(const SparseTransport::Entry* entry, const SparseTransport::Entry* end,
                                  const LightBlock* in, LightBlock* result) {
  LightBlock sum;
  for (; entry != end; ++entry) {
    // Columns are all over the place; the rows after this one follow in memory.
    const auto* ahead = reinterpret_cast<const char*>(&in[entry[kAhead].column]);
    for (std::size_t line = 0; line < sizeof(LightBlock); line += 64) __builtin_prefetch(ahead + line);
    const LightBlock& x = in[entry->column];
    for (int l = 0; l < kLightBlock; ++l) sum.channel[0][l] += entry->weight.x * x.channel[0][l];
    for (int l = 0; l < kLightBlock; ++l) sum.channel[1][l] += entry->weight.y * x.channel[1][l];
    for (int l = 0; l < kLightBlock; ++l) sum.channel[2][l] += entry->weight.z * x.channel[2][l];
  }
  *result = sum;
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
  constexpr std::size_t kRows = 512;
  renderer::parallel_for((matrix.row_count() + kRows - 1) / kRows, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kRows; i < std::min(matrix.row_count(), (chunk + 1) * kRows); ++i) {
      const auto row = matrix.row(i);
      multiply_row(row.data(), row.data() + row.size(), in.data(), &result[i]);
    }
  });
}

}  // namespace chiaro::inverse
