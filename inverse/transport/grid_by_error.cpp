#include "inverse/transport/grid_by_error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "inverse/transport/eigen_vectors.h"
#include "inverse/transport/gather_operator.h"
#include "inverse/transport/light_response.h"
#include "renderer/core/error.h"
#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

using renderer::RayTracer;
using renderer::Sampler;

constexpr std::size_t kReceivers = 300, kPositions = 64;
constexpr int kPointsPerSample = 8;
constexpr double kFirstLights = 64;
// From one grid to the next: the spacing that would do if the error fell with this power of it, within bounds.
constexpr double kPower = 1.3, kLeastStep = 0.5, kMostStep = 0.85;

// Holds grids against positions between their lights. The same operator gives both, so that its noise does not count.
class InterpolationTest {
 public:
  InterpolationTest(const RayTracer& tracer, const Receivers& receivers, const LightGrid& first,
                    const BakeSettings& settings)
      : tracer_(tracer),
        samples_(select_receivers(receivers, evenly_spread(receivers.size(), kReceivers)).samples),
        gather_(make_gather_operator(tracer, samples_,
                                     {.samples = settings.samples,
                                      .points_per_sample = kPointsPerSample,
                                      .bounces = settings.bounces,
                                      .seed = settings.seed})),
        positions_(random_light_positions(first, kPositions, settings.seed)) {
    const std::vector<Vec3f> indirect = indirect_of(positions_);
    TransportCache no_lights;
    no_lights.receiver_count = samples_.size();
    const LightResponse response(tracer_, samples_, no_lights);
    for (std::size_t k = 0; k < positions_.size(); ++k) {
      exact_.push_back(response.direct(to_eigen(positions_[k])));
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        exact_[k].row(Eigen::Index(i)) += to_eigen(indirect[k * samples_.size() + i]).transpose();
      }
    }
  }

  double median_error(const LightGrid& grid) const {
    TransportCache cache;
    cache.grid = grid;
    cache.receiver_count = samples_.size();
    cache.indirect = indirect_of(grid.positions);
    cache.visibility = visibility_of(grid.positions);
    const LightResponse response(tracer_, samples_, cache);
    std::vector<double> errors;
    for (std::size_t k = 0; k < positions_.size(); ++k) {
      const double norm = exact_[k].norm();
      if (!(norm > 0)) continue;
      const Column interpolated = response.evaluate(to_eigen(positions_[k]), Evaluation::kInterpolated);
      errors.push_back((interpolated - exact_[k]).norm() / norm);
    }
    if (errors.empty()) return 0;
    const auto middle = errors.begin() + std::ptrdiff_t(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return *middle;
  }

 private:
  // Row-major by light, as the next.
  std::vector<Vec3f> indirect_of(std::span<const Vec3f> lights) const {
    std::vector<Vec3f> all(lights.size() * samples_.size());
    for (std::size_t first = 0; first < lights.size() && !gather_.points.empty(); first += kLightBlock) {
      const std::size_t count = std::min<std::size_t>(kLightBlock, lights.size() - first);
      const std::vector<LightBlock> blocks = indirect_illumination(tracer_, gather_, lights.subspan(first, count));
      for (std::size_t l = 0; l < count; ++l) {
        for (std::size_t i = 0; i < samples_.size(); ++i) {
          const auto& channel = blocks[i].channel;
          all[(first + l) * samples_.size() + i] = {channel[0][l], channel[1][l], channel[2][l]};
        }
      }
    }
    return all;
  }

  std::vector<std::uint8_t> visibility_of(const std::vector<Vec3f>& lights) const {
    std::vector<std::uint8_t> all(lights.size() * samples_.size(), 0);
    renderer::parallel_for(lights.size(), [&](std::size_t l) {
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        all[l * samples_.size() + i] = sees(tracer_, samples_[i], lights[l], std::uint32_t(i)) ? 1 : 0;
      }
    });
    return all;
  }

  const RayTracer& tracer_;
  std::vector<renderer::SurfaceSample> samples_;
  GatherOperator gather_;
  std::vector<Vec3f> positions_;
  std::vector<Column> exact_;
};

}  // namespace

std::vector<Vec3f> random_light_positions(const LightGrid& grid, std::size_t count, std::uint64_t seed) {
  std::vector<Vec3f> positions;
  for (std::uint32_t i = 0; positions.size() < count; ++i) {
    Sampler sampler(seed, 0, i);
    const renderer::Vec2f xy = sampler.next_2d();
    const Vec3f position = grid.region.min + grid.region.extent() * Vec3f{xy.x, xy.y, sampler.next_1d()};
    std::size_t node = 0, stride = 1;
    for (int a = 0; a < 3; ++a) {
      const float at = grid.spacing[a] > 0 ? (position[a] - grid.origin[a]) / grid.spacing[a] : 0;
      node += stride * std::size_t(std::clamp(int(std::lround(at)), 0, grid.counts[a] - 1));
      stride *= std::size_t(grid.counts[a]);
    }
    if (grid.light_of_node[node] >= 0) positions.push_back(position);
  }
  return positions;
}

LightGrid choose_light_grid(const RayTracer& tracer, const Receivers& receivers, const LightGridOptions& options,
                            const BakeSettings& settings, const renderer::Control& control) {
  if (!(options.error > 0)) return make_light_grid(tracer, options);
  const InterpolationTest test(tracer, receivers, make_light_grid(tracer, {.region = options.region}), settings);
  double lights = kFirstLights, least = std::numeric_limits<double>::infinity();
  while (lights <= double(kMostGridLights)) {
    if (control.stop_requested()) throw renderer::Interruption();
    LightGrid grid = make_light_grid(tracer, {.region = options.region, .lights = lights});
    const double error = test.median_error(grid);
    if (error <= options.error) return grid;
    least = std::min(least, error);
    const double step = std::clamp(std::pow(options.error / error, 1 / kPower), kLeastStep, kMostStep);
    lights /= step * step * step;
  }
  throw renderer::Error({tracer.scene().path, "option --grid",
                         fmt::format("{:.3g} % takes more than {} lights", 100 * options.error, kMostGridLights),
                         fmt::format("{:.1f} % or more, or a smaller --region", 100 * least)});
}

}  // namespace chiaro::inverse
