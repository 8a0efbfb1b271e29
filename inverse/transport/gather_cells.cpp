#include "inverse/transport/gather_cells.h"

#include <cmath>
#include <numeric>

#include "inverse/transport/nearest_gather_point.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

using renderer::SurfaceSample;

namespace {

constexpr std::size_t kHiddenPerGatherPoint = 8;  // samples that see no gather point, of which one becomes another …
constexpr int kMostRounds = 6;                    // … again and again …
constexpr std::size_t kFewHidden = 100;           // … until they are this part of all, or gather points the most

std::vector<SurfaceSample> every_nth(const std::vector<SurfaceSample>& all, std::size_t count) {
  std::vector<SurfaceSample> chosen;
  count = std::min(count, all.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

// Of each sample the gather point that it sees, if any.
using Cells = std::vector<std::optional<std::uint32_t>>;

Cells find_cells(const std::vector<SurfaceSample>& all, const NearestGatherPoint& nearest,
                 const renderer::Control& control) {
  Cells cells(all.size());
  renderer::parallel_for(all.size(), "", control, [&](std::size_t i) { cells[i] = nearest.find_seen(all[i]); });
  return cells;
}

std::vector<SurfaceSample> that_see_none(const std::vector<SurfaceSample>& all, const Cells& cells) {
  std::vector<SurfaceSample> hidden;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!cells[i]) hidden.push_back(all[i]);
  }
  return hidden;
}

// The same cells when these gather points have come to those that there were: of samples that none of them is nearer
// to, and that see one, it stays.
void find_cells_again(const std::vector<SurfaceSample>& all, const std::vector<SurfaceSample>& points,
                      const std::vector<SurfaceSample>& more, const NearestGatherPoint& nearest, float spacing,
                      const renderer::Control& control, Cells& cells) {
  const SampleTree among_more(more, spacing);
  renderer::parallel_for(all.size(), "", control, [&](std::size_t i) {
    std::uint32_t found = 0;
    among_more.find_nearest(all[i], {&found, 1});
    const auto distance = [&](const SurfaceSample& to) { return among_more.squared_distance(all[i], to); };
    if (!cells[i] || distance(more[found]) < distance(points[*cells[i]])) cells[i] = nearest.find_seen(all[i]);
  });
}

// Samples that see no gather point are of no cell.
void fill_cells(GatherOperator& gather, const std::vector<SurfaceSample>& all, const Cells& cells) {
  gather.cell_start.assign(gather.points.size() + 1, 0);
  for (const auto& cell : cells) {
    if (cell) ++gather.cell_start[*cell + 1];
  }
  std::partial_sum(gather.cell_start.begin(), gather.cell_start.end(), gather.cell_start.begin());
  std::vector<std::size_t> next(gather.cell_start.begin(), gather.cell_start.end() - 1);
  gather.cell_samples.resize(gather.cell_start.back());
  gather.cell_radius.assign(gather.points.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!cells[i]) continue;
    gather.cell_samples[next[*cells[i]]++] = all[i];
    gather.cell_radius[*cells[i]] += length_squared(all[i].position - gather.points[*cells[i]].position);
  }
  for (std::size_t c = 0; c < gather.points.size(); ++c) {
    const std::size_t count = gather.cell_start[c + 1] - gather.cell_start[c];
    gather.cell_radius[c] = std::sqrt(gather.cell_radius[c] / float(std::max<std::size_t>(1, count)));
  }
}

}  // namespace

void place_gather_points(GatherOperator& gather, const renderer::RayTracer& tracer,
                         const std::vector<SurfaceSample>& all, std::size_t wanted, const renderer::Control& control) {
  gather.points = every_nth(all, wanted);
  if (gather.points.empty()) return;
  const float spacing = typical_spacing(tracer.bounds(), gather.points.size());
  gather.nearest = std::make_shared<const NearestGatherPoint>(tracer, gather.points, spacing);
  const renderer::Control quiet = control.without_progress();
  Cells cells = find_cells(all, *gather.nearest, quiet);
  const std::size_t most = kMostGatherPoints * gather.points.size();
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<SurfaceSample> hidden = that_see_none(all, cells);
    if (round > 0 && hidden.size() < all.size() / kFewHidden) break;
    const std::size_t room = std::min(gather.points.size() / 2, most - gather.points.size());
    const std::vector<SurfaceSample> more = every_nth(hidden, std::min(hidden.size() / kHiddenPerGatherPoint, room));
    if (more.empty()) break;
    gather.points.insert(gather.points.end(), more.begin(), more.end());
    gather.nearest = std::make_shared<const NearestGatherPoint>(tracer, gather.points, spacing);
    find_cells_again(all, gather.points, more, *gather.nearest, spacing, quiet, cells);
  }
  fill_cells(gather, all, cells);
}

}  // namespace chiaro::inverse
