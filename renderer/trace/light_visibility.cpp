#include "renderer/trace/light_visibility.h"

#include <algorithm>
#include <cmath>

namespace chiaro::renderer {
namespace {

constexpr std::size_t kMostCounts = 500'000;  // 6 MB
constexpr double kMostCells = 32 * 32 * 32;
constexpr std::size_t kWays = 6;
// Of a light and a part: a pass brings fewer than 2³² − this.
constexpr std::uint64_t kManyRays = std::uint64_t(1) << 28;
// No light's chance falls below this part of what it would be if it were seen.
constexpr float kLeastFactor = 0.05F;

std::size_t way_of(Vec3f normal) {
  const Vec3f a = abs(normal);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return 2 * std::size_t(axis) + (normal[axis] < 0 ? 1 : 0);
}

// Metres: of cubes of which about so many fill the box. An axis along which it is thinner than they counts for nothing.
double edge_of_cells(Vec3f extent, double cells) {
  double edge = 0;
  for (int pass = 0; pass < 3; ++pass) {
    double product = 1;
    int axes = 0;
    for (int a = 0; a < 3; ++a) {
      if (!(double(extent[a]) > edge)) continue;
      product *= double(extent[a]);
      ++axes;
    }
    if (axes > 0) edge = std::pow(product / cells, 1.0 / axes);
  }
  return edge;
}

}  // namespace

LightVisibility::LightVisibility(const Box3f& bounds, std::size_t lights)
    : lights_(std::max<std::size_t>(1, (lights + kLanes - 1) / kLanes) * kLanes), origin_(bounds.min) {
  const double cells = std::clamp(double(kMostCounts) / double(kWays * lights_), 1.0, kMostCells);
  const Vec3f extent = bounds.extent();
  const double edge = edge_of_cells(extent, cells);
  std::size_t all = kWays * lights_;
  for (int a = 0; a < 3; ++a) {
    counts_[a] = edge > 0 ? std::max(1, int(double(extent[a]) / edge)) : 1;
    cells_per_metre_[a] = extent[a] > 0 ? float(counts_[a]) / extent[a] : 0;
    all *= std::size_t(counts_[a]);
  }
  rays_ = std::vector<std::atomic<std::uint64_t>>(all);
  factors_.assign(all, 1);
}

std::size_t LightVisibility::part_of(Vec3f point, Vec3f normal) const {
  std::size_t cell = 0;
  for (int a = 2; a >= 0; --a) {
    const float at = (point[a] - origin_[a]) * cells_per_metre_[a];
    cell = cell * std::size_t(counts_[a]) + std::size_t(std::clamp(at, 0.0F, float(counts_[a] - 1)));
  }
  return kWays * cell + way_of(normal);
}

void LightVisibility::record(std::size_t part, std::size_t light, bool seen) {
  rays_[part * lights_ + light].fetch_add(seen ? (std::uint64_t(1) << 32) + 1 : 1, std::memory_order_relaxed);
}

// The chance of least variance is in proportion to the root of the mean square, which for a light that is seen or not
// is the root of how often it is seen; that as if one more ray had seen it.
void LightVisibility::learn() {
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const std::uint64_t rays = rays_[i].load(std::memory_order_relaxed);
    if (rays == 0) continue;
    const std::uint64_t all = rays & 0xffffffffU, seen = rays >> 32;
    factors_[i] = std::max(kLeastFactor, std::sqrt((float(seen) + 1) / (float(all) + 1)));
    // Later rays find room.
    if (all > kManyRays) rays_[i].store(((seen / 2) << 32) + all / 2, std::memory_order_relaxed);
  }
}

}  // namespace chiaro::renderer
