#include "inverse/transport/grid_by_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "inverse/numerics/median.h"
#include "inverse/transport/eigen_vectors.h"
#include "inverse/transport/gather_operator.h"
#include "inverse/transport/light_response.h"
#include "renderer/core/error.h"
#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;

constexpr std::size_t kReceivers = 300, kPositions = 64;
constexpr int kPointsPerSample = 8;
constexpr double kFirstLights = 64;
// From one grid to the next: the spacing that would do if the error fell with this power of it, within bounds.
constexpr double kPower = 1.3, kLeastStep = 0.5, kMostStep = 0.85;

constexpr double kLocalError = 4;         // of a single position, over the median's
constexpr double kDarkest = 0.01;         // of the median light: what lights less is not worth finer cells
constexpr double kMostFinerLights = 1;    // over those of the nodes
constexpr float kTouching = 0.02F;        // of a finer cell
constexpr std::uint32_t kMostTries = 8;   // for a test position in free space
constexpr std::uint64_t kTestSeed = 101;  // apart from those of other positions

// To two digits.
double rounded_up(double value) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::ceil(value / digit) * digit;
}

// Holds grids against positions between their lights. The same operator gives both, so that its noise does not count.
class InterpolationTest {
 public:
  // control: to be interrupted.
  InterpolationTest(const RayTracer& tracer, const Receivers& receivers, const BakeSettings& settings,
                    const renderer::Control& control)
      : tracer_(tracer),
        samples_(select_receivers(receivers, evenly_spread(receivers.size(), kReceivers)).samples),
        gather_(make_gather_operator(tracer, samples_,
                                     {.samples = settings.samples,
                                      .points_per_sample = kPointsPerSample,
                                      .bounces = settings.bounces,
                                      .seed = settings.seed},
                                     control.without_progress())),
        control_(control.without_progress()) {}

  // What a cache has of one light.
  struct Row {
    std::vector<std::uint8_t> visibility;
    std::vector<Vec3f> indirect;
  };

  std::vector<Row> rows_of(std::span<const Vec3f> lights) const {
    std::vector<Row> rows(lights.size(),
                          {std::vector<std::uint8_t>(samples_.size()), std::vector<Vec3f>(samples_.size())});
    if (!gather_.points.empty()) {
      auto indirect = indirect_illumination_by_light(tracer_, gather_, lights, control_);
      for (std::size_t l = 0; l < lights.size(); ++l) rows[l].indirect = std::move(indirect[l]);
    }
    renderer::parallel_for(lights.size(), "grid", control_, [&](std::size_t l) {
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        rows[l].visibility[i] = sees(tracer_, samples_[i], lights[l], std::uint32_t(i)) ? 1 : 0;
      }
    });
    return rows;
  }

  // The light of positions, computed there.
  struct Positions {
    std::vector<Vec3f> at;
    std::vector<Column> light;
    std::vector<double> norm;
  };

  Positions exact(std::vector<Vec3f> at) const {
    Positions positions{std::move(at), {}, {}};
    const std::vector<Row> rows = rows_of(positions.at);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Column light(Eigen::Index(samples_.size()), 3);
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const float direct = rows[k].visibility[i] != 0 ? unoccluded_illumination(samples_[i], positions.at[k]) : 0;
        light.row(Eigen::Index(i)) = to_eigen(rows[k].indirect[i] + Vec3f{direct, direct, direct}).transpose();
      }
      positions.norm.push_back(light.norm());
      positions.light.push_back(std::move(light));
    }
    return positions;
  }

  // Relative, of each position; 0 where there is no light at all. rows: of the grid's lights.
  std::vector<double> errors(const LightGrid& grid, const std::vector<const Row*>& rows,
                             const Positions& positions) const {
    TransportCache cache;
    cache.grid = grid;
    cache.receiver_count = samples_.size();
    for (const Row* row : rows) {
      cache.visibility.insert(cache.visibility.end(), row->visibility.begin(), row->visibility.end());
      cache.indirect.insert(cache.indirect.end(), row->indirect.begin(), row->indirect.end());
    }
    const LightResponse response(tracer_, samples_, cache);
    std::vector<double> errors(positions.at.size());
    renderer::parallel_for(errors.size(), [&](std::size_t k) {
      if (!(positions.norm[k] > 0)) return;
      const Column interpolated = response.evaluate(to_eigen(positions.at[k]), Evaluation::kInterpolated);
      errors[k] = (interpolated - positions.light[k]).norm() / positions.norm[k];
    });
    return errors;
  }

 private:
  const RayTracer& tracer_;
  std::vector<renderer::SurfaceSample> samples_;
  GatherOperator gather_;
  renderer::Control control_;
};

using Row = InterpolationTest::Row;

std::vector<const Row*> pointers_to(const std::vector<Row>& rows) {
  std::vector<const Row*> pointers;
  for (const Row& row : rows) pointers.push_back(&row);
  return pointers;
}

double volume_of(const Box3f& box) {
  const Vec3f extent = box.extent();
  return double(extent.x) * double(extent.y) * double(extent.z);
}

// What of a box belongs to each of some places; all of it where there are none.
std::vector<Box3f> common_parts(const Box3f& box, const std::vector<Box3f>& places) {
  if (places.empty()) return {box};
  std::vector<Box3f> common;
  for (const Box3f& place : places) {
    const Box3f part{max(box.min, place.min), min(box.max, place.max)};
    if (!part.empty()) common.push_back(part);
  }
  return common;
}

// In free space where lights may stand, evenly.
std::vector<Vec3f> test_positions(const RayTracer& tracer, const Box3f& region, const std::vector<Box3f>& places,
                                  std::uint64_t seed) {
  const std::vector<Box3f> parts = common_parts(region, places);
  double volume = 0;
  for (const Box3f& part : parts) volume += volume_of(part);
  std::vector<Vec3f> positions;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double share = volume > 0 ? volume_of(parts[p]) / volume : 1 / double(parts.size());
    const std::size_t count = std::max<std::size_t>(1, std::size_t(std::lround(share * double(kPositions))));
    const std::vector<Vec3f> some = random_light_positions(tracer, parts[p], count, seed + p);
    positions.insert(positions.end(), some.begin(), some.end());
  }
  return positions;
}

// The coarsest regular grid of this median error.
LightGrid regular_grid(const RayTracer& tracer, const InterpolationTest& test, const LightGridOptions& options,
                       const BakeSettings& settings, const renderer::Control& control) {
  const Box3f region = make_light_grid(tracer, {.region = options.region, .parts = options.parts}, control).region;
  const auto positions = test.exact(test_positions(tracer, region, options.parts, settings.seed));
  if (positions.at.empty()) {
    throw NoUsableGrid({tracer.scene().path, "option --grid",
                        "no place between lights was found free to tell the error of", "X,Y,Z, or another --region"});
  }
  double lights = kFirstLights, least = std::numeric_limits<double>::infinity();
  while (lights <= double(kMostGridLights)) {
    control.stop_if_requested();
    LightGrid grid =
        make_light_grid(tracer, {.region = options.region, .parts = options.parts, .lights = lights}, control);
    const double error = numerics::median(test.errors(grid, pointers_to(test.rows_of(grid.positions)), positions));
    if (error <= options.error) return grid;
    least = std::min(least, error);
    const double step = std::clamp(std::pow(options.error / error, 1 / kPower), kLeastStep, kMostStep);
    lights /= step * step * step;
  }
  throw NoUsableGrid({tracer.scene().path, "option --grid",
                      fmt::format("{:.3g} % takes more than {} lights", 100 * options.error, kMostGridLights),
                      fmt::format("{:.3g} % or more, or a smaller --region", rounded_up(100 * least))});
}

std::vector<GridCell> whole_cells(const LightGrid& grid) {
  std::vector<GridCell> cells;
  for (std::size_t node = 0; node < grid.light_of_node.size(); ++node) cells.push_back(cell_of(grid, {0, node}));
  return cells;
}

// Along an axis on which the region is flat, one half is both.
std::vector<GridCell> halves(const LightGrid& grid, const GridCell& cell) {
  std::vector<GridCell> parts;
  for (std::uint32_t z = 0; z < (grid.spacing.z > 0 ? 2 : 1); ++z) {
    for (std::uint32_t y = 0; y < (grid.spacing.y > 0 ? 2 : 1); ++y) {
      for (std::uint32_t x = 0; x < (grid.spacing.x > 0 ? 2 : 1); ++x) {
        parts.push_back({cell.level + 1, {2 * cell.at[0] + x, 2 * cell.at[1] + y, 2 * cell.at[2] + z}});
      }
    }
  }
  return parts;
}

// Halves cells where interpolation between the lights that there are is wrong, again and again.
class Refinement {
 public:
  // places: where lights may stand; none: anywhere.
  Refinement(const RayTracer& tracer, const InterpolationTest& test, LightGrid grid, std::vector<Box3f> places,
             double most_error, const BakeSettings& settings)
      : free_space_(tracer),
        test_(test),
        grid_(std::move(grid)),
        places_(std::move(places)),
        most_error_(most_error),
        seed_(settings.seed + kTestSeed),
        rows_of_nodes_(test.rows_of(grid_.positions)) {}

  LightGrid run(const renderer::Control& control) {
    std::vector<GridCell> cells = whole_cells(grid_);
    for (int level = 1; level <= kMostLevels && !cells.empty(); ++level) {
      control.stop_if_requested();
      std::vector<GridCell> parts;
      for (const GridCell& cell : wrong_ones(cells, control)) {
        const std::vector<GridCell> these = halves(grid_, cell);
        parts.insert(parts.end(), these.begin(), these.end());
        rows_of_finer_.erase({cell.level, number_of(grid_, cell)});
      }
      add(parts);
      cells = std::move(parts);
    }
    return grid_;
  }

 private:
  // In free space where lights may stand; absent where none is found.
  std::optional<Vec3f> test_position(const GridCell& cell) const {
    const Box3f bounds = bounds_of(grid_, cell);
    const std::vector<Box3f> parts = common_parts(bounds, places_);
    if (parts.empty()) return std::nullopt;
    for (std::uint32_t k = 0; k < kMostTries; ++k) {
      renderer::Sampler sampler(seed_ + std::uint64_t(cell.level), std::uint32_t(number_of(grid_, cell)), k);
      const Vec3f at = random_position(parts[k % parts.size()], sampler);
      if (free_space_.contains(at, kTouching * bounds.diagonal())) return at;
    }
    return std::nullopt;
  }

  // The worst of them first, as many as there may be lights.
  std::vector<GridCell> wrong_ones(const std::vector<GridCell>& cells, const renderer::Control& control) {
    std::vector<std::optional<Vec3f>> place(cells.size());
    const auto quiet = control.without_progress();
    renderer::parallel_for(cells.size(), "", quiet, [&](std::size_t c) { place[c] = test_position(cells[c]); });
    std::vector<std::size_t> tested;
    std::vector<Vec3f> positions;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (place[c]) tested.push_back(c), positions.push_back(*place[c]);
    }
    const auto exact = test_.exact(std::move(positions));
    if (!bright_) bright_ = kDarkest * numerics::median(exact.norm);
    const std::vector<double> errors = test_.errors(grid_, rows(), exact);
    std::vector<std::size_t> order;  // of the tests
    for (std::size_t k = 0; k < errors.size(); ++k) {
      if (exact.norm[k] > *bright_ && errors[k] > most_error_) order.push_back(k);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
    const double room = kMostFinerLights * double(grid_.node_light_count()) - double(rows_of_finer_.size());
    order.resize(std::min(order.size(), std::size_t(std::max(0.0, room / 8))));
    std::vector<GridCell> wrong;
    for (const std::size_t k : order) wrong.push_back(cells[tested[k]]);
    return wrong;
  }

  void add(const std::vector<GridCell>& parts) {
    std::vector<LightGrid::FinerCell> cells;
    std::vector<Vec3f> positions;
    for (const GridCell& part : parts) {
      const Box3f bounds = bounds_of(grid_, part);
      const Vec3f middle = bounds.min + 0.5F * bounds.extent();
      if (common_parts(bounds, places_).empty()) continue;
      if (!free_space_.contains(middle, kTouching * bounds.diagonal())) continue;
      cells.push_back({part.level, number_of(grid_, part)});
      positions.push_back(middle);
    }
    std::vector<Row> rows = test_.rows_of(positions);
    for (std::size_t k = 0; k < cells.size(); ++k) rows_of_finer_[cells[k]] = std::move(rows[k]);
    std::vector<LightGrid::FinerCell> all;
    for (const auto& [cell, row] : rows_of_finer_) all.push_back(cell);
    set_finer_cells(grid_, std::move(all));
  }

  std::vector<const Row*> rows() const {
    std::vector<const Row*> all = pointers_to(rows_of_nodes_);
    for (const auto& [cell, row] : rows_of_finer_) all.push_back(&row);
    return all;
  }

  FreeSpace free_space_;
  const InterpolationTest& test_;
  LightGrid grid_;
  std::vector<Box3f> places_;
  double most_error_;
  std::uint64_t seed_;
  std::vector<Row> rows_of_nodes_;
  std::map<LightGrid::FinerCell, Row> rows_of_finer_;
  std::optional<double> bright_;  // norm of light that counts
};

}  // namespace

LightGrid choose_light_grid(const RayTracer& tracer, const Receivers& receivers, const LightGridOptions& options,
                            const BakeSettings& settings, const renderer::Control& control) {
  if (!(options.error > 0)) return make_light_grid(tracer, options, control);
  const InterpolationTest test(tracer, receivers, settings, control);
  LightGrid grid = regular_grid(tracer, test, options, settings, control);
  return Refinement(tracer, test, std::move(grid), options.parts, kLocalError * options.error, settings).run(control);
}

}  // namespace chiaro::inverse
