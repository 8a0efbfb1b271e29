#pragma once
// Sparse matrices of RGB weights, and their product with blocks of light columns.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::inverse {

// Compressed rows.
class SparseTransport {
 public:
  struct Entry {
    std::uint32_t column;
    renderer::Vec3f weight;
  };

  // Rows in order; entries of one row with the same column are added up.
  static SparseTransport from_rows(std::vector<std::vector<Entry>>&& rows);

  // Rows become columns; `columns` of this matrix become rows.
  SparseTransport transposed(std::size_t columns) const;

  std::size_t row_count() const { return row_start_.size() - 1; }
  std::span<const Entry> row(std::size_t i) const {
    return {entries_.data() + row_start_[i], entries_.data() + row_start_[i + 1]};
  }
  std::size_t entry_count() const { return row_start_.back(); }

 private:
  std::vector<std::size_t> row_start_{0};
  std::vector<Entry> entries_;  // and some beyond the last, so that products may read ahead
};

// Illumination of one point by several lights side by side, per channel.
template <int Lanes>
struct alignas(4 * Lanes) LightLanes {
  static constexpr int kLanes = Lanes;
  float channel[3][Lanes] = {};
};

// A bake handles lights this many at a time …
inline constexpr int kLightBlock = 16;
using LightBlock = LightLanes<kLightBlock>;
// … one light with its derivatives, or up to four lights, take less, and one light alone the least.
using LightQuad = LightLanes<4>;
using OneLight = LightLanes<1>;

// result[i] = Σ_k row(i)[k].weight · in[column], per channel and light, for all rows.
void multiply(const SparseTransport& matrix, std::span<const LightBlock> in, std::span<LightBlock> result);
void multiply(const SparseTransport& matrix, std::span<const LightQuad> in, std::span<LightQuad> result);
void multiply(const SparseTransport& matrix, std::span<const OneLight> in, std::span<OneLight> result);
// The same for the rows from `first` on, as many as there are results; in one thread.
void multiply_rows(const SparseTransport& matrix, std::size_t first, std::span<const LightBlock> in,
                   std::span<LightBlock> result);
void multiply_rows(const SparseTransport& matrix, std::size_t first, std::span<const LightQuad> in,
                   std::span<LightQuad> result);
void multiply_rows(const SparseTransport& matrix, std::size_t first, std::span<const OneLight> in,
                   std::span<OneLight> result);

}  // namespace chiaro::inverse
