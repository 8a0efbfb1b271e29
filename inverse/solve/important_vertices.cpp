// Chen, Lighting Design with Illumination Brush, 2008, section 3.2.

#include "inverse/solve/important_vertices.h"

#include <algorithm>
#include <set>

#include "inverse/numerics/cotangent_laplacian.h"
#include "inverse/numerics/weighted_sampling.h"
#include "renderer/core/control.h"
#include "renderer/core/sampler.h"

namespace chiaro::inverse {
namespace {

constexpr int kGeometryRays = 32;
constexpr int kNeighbourRings = 3;
constexpr double kLeastDensity = 0.02;     // so that no painted receiver is out of reach
constexpr std::size_t kEnoughLit = 200;    // of those drawn, or a quarter
constexpr double kLargestQuantile = 0.99;  // counts as 1: a few slivers must not make all else look flat

// Harmonic mean of the distances to what a receiver sees (3.3); at most `diagonal`.
double harmonic_mean_distance(const renderer::RayTracer& tracer, const renderer::SurfaceSample& at, double diagonal,
                              std::uint64_t seed, std::uint32_t stream) {
  double sum = 0;
  const renderer::Frame3f frame(at.normal);
  const Vec3f origin = renderer::offset_point(at.position, at.normal);
  for (int k = 0; k < kGeometryRays; ++k) {
    renderer::Sampler sampler(seed, stream, std::uint32_t(k));
    const Vec3f direction = frame.world_from_local(renderer::sample_cosine_hemisphere(sampler.next_2d()));
    const auto hit = tracer.intersect({origin, direction, 0, renderer::kInfinity, sampler.next_bits()});
    if (hit) sum += 1 / std::max(double(hit->distance), 1e-6 * diagonal);
  }
  return sum > 0 ? std::min(diagonal, kGeometryRays / sum) : diagonal;
}

std::vector<double> geometry_term(const renderer::RayTracer& tracer, const Receivers& receivers, std::uint64_t seed) {
  const double diagonal = double(tracer.bounds().diagonal());
  std::vector<double> geometry(receivers.size());
  constexpr std::size_t kBlock = 256;
  renderer::parallel_for((receivers.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(receivers.size(), (block + 1) * kBlock); ++i) {
      const double mean = harmonic_mean_distance(tracer, receivers.samples[i], diagonal, seed, std::uint32_t(i));
      geometry[i] = diagonal - mean;  // (3.3)
    }
  });
  return geometry;
}

std::vector<double> illumination_term(const Target& target) {
  const Receivers& r = target.receivers;
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> value;  // V of HSV
  for (std::size_t i = 0; i < r.size(); ++i) {
    positions.emplace_back(r.positions[i].x, r.positions[i].y, r.positions[i].z);
    value.push_back(double(max_component(target.illumination[i])));
  }
  std::vector<double> laplacian = numerics::cotangent_laplacian(positions, r.triangles, value);
  for (double& l : laplacian) l = std::abs(l);
  return laplacian;
}

void normalize(std::vector<double>& values) {
  std::vector<double> sorted = values;
  const auto nth = sorted.begin() + std::ptrdiff_t(kLargestQuantile * double(sorted.size() - 1));
  std::nth_element(sorted.begin(), nth, sorted.end());
  double scale = *nth;
  if (!(scale > 0)) scale = *std::max_element(values.begin(), values.end());
  for (double& v : values) v = scale > 0 ? std::clamp(v / scale, 0.0, 1.0) : 0;
}

// Receivers that hold more than 1 / count of the target's squared norm each: those right beside a light, which decide
// what (3.6) says and which a draw would miss. At most an eighth of the count; the brightest first.
std::vector<std::size_t> brightest_receivers(const Target& target, std::size_t count) {
  double total = 0;
  std::vector<std::pair<double, std::size_t>> energy;
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    const double e = double(target.weight[i]) * squared_norm(target.illumination[i]);
    total += e;
    energy.emplace_back(-e, i);
  }
  std::sort(energy.begin(), energy.end());
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count / 8 && -energy[k].first * double(count) > total; ++k) {
    chosen.push_back(energy[k].second);
  }
  return chosen;
}

// Adds the neighbours along the mesh, which tell from where a bright receiver is lit, as long as there are fewer than
// `most`.
std::vector<std::size_t> with_neighbours(const Receivers& receivers, const std::vector<std::size_t>& some,
                                         std::size_t most) {
  std::set<std::size_t> grown(some.begin(), some.end());
  for (int ring = 0; ring < kNeighbourRings; ++ring) {
    const std::set<std::size_t> inner = grown;
    for (const renderer::Triangle& t : receivers.triangles) {
      if (!inner.contains(t[0]) && !inner.contains(t[1]) && !inner.contains(t[2])) continue;
      for (const std::uint32_t v : t) {
        if (grown.size() < most) grown.insert(v);
      }
    }
  }
  return {grown.begin(), grown.end()};
}

// Where a draw by these densities would hardly find a receiver that is lit, as of a pool of light in a large scene, the
// lit ones become so likely that it finds some.
void make_lit_likely(const Target& target, std::size_t count, std::vector<double>& density) {
  const double wanted = double(std::min(kEnoughLit, count / 4));
  const auto is_lit = [&](std::size_t i) { return max_component(target.illumination[i]) > 0; };
  double lit = 0, unlit = 0, number_of_lit = 0;
  for (std::size_t i = 0; i < density.size(); ++i) {
    (is_lit(i) ? lit : unlit) += density[i];
    number_of_lit += is_lit(i) && density[i] > 0 ? 1 : 0;
  }
  const double share = std::min(wanted, number_of_lit) / double(std::max<std::size_t>(1, count));
  if (!(lit > 0) || !(unlit > 0) || lit / (lit + unlit) >= share) return;
  const double factor = share / (1 - share) * unlit / lit;
  for (std::size_t i = 0; i < density.size(); ++i) density[i] *= is_lit(i) ? factor : 1;
}

}  // namespace

Importance choose_important_vertices(const renderer::RayTracer& tracer, const Target& target,
                                     const ImportanceOptions& options) {
  Importance importance;
  importance.geometry = geometry_term(tracer, target.receivers, options.seed);
  importance.illumination = illumination_term(target);
  normalize(importance.geometry);
  normalize(importance.illumination);
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    const double total = options.geometry_weight * importance.geometry[i] +
                         options.illumination_weight * importance.illumination[i];  // (3.2)
    importance.total.push_back(target.weight[i] > 0 ? total : 0);
  }
  return choose_again(std::move(importance), target, std::size_t(options.count), options.seed);
}

Importance choose_again(Importance importance, const Target& target, std::size_t most, std::uint64_t seed) {
  std::vector<double> density;
  std::size_t painted = 0;
  for (std::size_t i = 0; i < target.receivers.size(); ++i) {
    density.push_back(target.weight[i] > 0 ? importance.total[i] + kLeastDensity : 0);
    painted += target.weight[i] > 0 ? 1 : 0;
  }
  const std::size_t count = std::min(most, painted);
  importance.chosen = with_neighbours(target.receivers, brightest_receivers(target, count), count / 4);
  std::erase_if(importance.chosen, [&](std::size_t i) { return !(target.weight[i] > 0); });
  for (const std::size_t i : importance.chosen) density[i] = 0;
  const std::size_t left = count - importance.chosen.size();
  make_lit_likely(target, left, density);
  const auto drawn = numerics::sample_without_replacement(density, left, seed);
  const std::vector<double> probability = numerics::inclusion_probabilities(density, left);
  importance.chosen.insert(importance.chosen.end(), drawn.begin(), drawn.end());
  std::sort(importance.chosen.begin(), importance.chosen.end());
  importance.probability.clear();
  for (const std::size_t i : importance.chosen) importance.probability.push_back(density[i] > 0 ? probability[i] : 1);
  return importance;
}

}  // namespace chiaro::inverse
