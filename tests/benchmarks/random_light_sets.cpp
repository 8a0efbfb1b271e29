#include "tests/benchmarks/random_light_sets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <unistd.h>

#include <fmt/format.h>

#include "inverse/transport/bake_file.h"
#include "renderer/core/sampler.h"

namespace chiaro::benchmarks {
namespace {

using inverse::Target;
using renderer::PointLight;
using renderer::Vec3f;

constexpr float kApart = 0.05F, kFromSurfaces = 0.03F;  // of the diagonal
constexpr double kLeastShare = 0.02;                    // of all illumination
constexpr float kLeastIntensity = 5;                    // candela
constexpr double kOutshine = 10;                        // times what surfaces emit
constexpr float kIntensityRatio = 8;
constexpr std::size_t kPlaces = 200;  // to choose from
constexpr int kPilotSamples = 16;
constexpr std::size_t kSome = 1000;  // receivers
constexpr double kMemory = 4e9;      // of a bake, bytes

std::uint64_t seed_of(SetNumber number) { return (number.seed * 100 + number.lights) * 1000 + number.set; }

bool apart(const Stage& stage, const std::vector<PointLight>& lights, Vec3f position) {
  for (const PointLight& light : lights) {
    if (length(light.position - position) < kApart * stage.diagonal) return false;
  }
  for (const Vec3f p : stage.receivers.positions) {
    if (length(p - position) < kFromSurfaces * stage.diagonal) return false;
  }
  return true;
}

double sum_of(const std::vector<Vec3f>& values) {
  double sum = 0;
  for (const Vec3f v : values) sum += double(v.x + v.y + v.z);
  return sum;
}

double energy_of(const Stage& stage, const renderer::Lights& lights, bool emissive_surfaces) {
  return sum_of(trace_illumination(stage.tracer, stage.some.samples, lights, {8, -1, 77, emissive_surfaces}).value);
}

std::vector<double> energies_of(const Stage& stage, const std::vector<PointLight>& lights) {
  std::vector<double> energies;
  for (const PointLight& light : lights) energies.push_back(energy_of(stage, {light}, false));
  return energies;
}

bool each_matters(const std::vector<double>& energies) {
  const double all = std::accumulate(energies.begin(), energies.end(), 0.0);
  return *std::min_element(energies.begin(), energies.end()) >= kLeastShare * all;
}

// Where surfaces glow, as bright as leaves them little of the target's energy.
void outshine_surfaces(const Stage& stage, const std::vector<double>& energies, std::vector<PointLight>& lights) {
  const double emitted = energy_of(stage, {}, true);
  const double brighter = kOutshine * emitted / std::accumulate(energies.begin(), energies.end(), 0.0);
  for (PointLight& light : lights) light.intensity = std::max(1.0F, float(brighter)) * light.intensity;
}

Vec3f random_intensity(std::uint64_t seed, std::uint64_t attempt, std::uint32_t place) {
  renderer::Sampler sampler(seed + 17, std::uint32_t(attempt), place);
  const renderer::Vec2f u = sampler.next_2d();
  const float intensity = kLeastIntensity * std::pow(kIntensityRatio, u.x);
  Vec3f color{0.15F + 0.85F * u.y, 0.15F + 0.85F * sampler.next_1d(), 0.15F + 0.85F * sampler.next_1d()};
  color = color / max_component(color);
  return intensity * color;
}

Target newly_traced(const Stage& stage, const std::vector<PointLight>& lights, double noise, std::uint64_t seed) {
  renderer::Lights all(lights.begin(), lights.end());
  const auto pilot =
      trace_illumination(stage.tracer, stage.some.samples, all, {kPilotSamples, -1, seed * 7919 + 5, true});
  const double ratio = *relative_standard_error(pilot) / noise;
  const int samples = std::max(4, int(std::ceil(kPilotSamples * ratio * ratio)));
  const auto traced =
      trace_illumination(stage.tracer, stage.receivers.samples, all, {samples, -1, seed * 7919 + 6, true});
  return {stage.receivers, traced.value, std::vector<float>(stage.receivers.size(), 1),
          inverse::standard_error_per_receiver(traced)};
}

}  // namespace

Stage::Stage(const std::filesystem::path& scene, float edge)
    : file(scene),
      max_edge(edge),
      loaded(renderer::load_gltf(scene)),
      tracer(loaded.scene),
      receivers(inverse::make_receivers(loaded.scene, {.max_edge = edge})),
      some(inverse::select_receivers(receivers, inverse::evenly_spread(receivers.size(), kSome))),
      grid(inverse::make_light_grid(tracer, {})),
      diagonal(tracer.bounds().diagonal()) {}

TemporaryBake::TemporaryBake(const Stage& stage)
    : settings_{.samples = 256, .bounces = -1, .seed = 0, .materials = "gltf"},
      file_(std::filesystem::temp_directory_path() / fmt::format("chiaro_benchmark_{}.exr", getpid())) {
  inverse::Baker baker(stage.tracer, stage.receivers, stage.grid, settings_, kMemory);
  inverse::bake_to_file(baker, file_, {}, {});
}

TemporaryBake::~TemporaryBake() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

std::vector<PointLight> random_lights(const Stage& stage, SetNumber number) {
  const std::uint64_t seed = seed_of(number);
  for (std::uint64_t attempt = 0;; ++attempt) {
    std::vector<PointLight> lights;
    const auto places =
        inverse::random_light_positions(stage.tracer, stage.grid.region, kPlaces, seed * 1000 + attempt);
    for (std::uint32_t i = 0; i < places.size() && lights.size() < number.lights; ++i) {
      if (apart(stage, lights, places[i])) lights.push_back({"", places[i], random_intensity(seed, attempt, i)});
    }
    if (lights.size() < number.lights) continue;
    const std::vector<double> energies = energies_of(stage, lights);
    if (!each_matters(energies)) continue;
    outshine_surfaces(stage, energies, lights);
    return lights;
  }
}

Target traced_target(const Stage& stage, const std::vector<PointLight>& lights, SetNumber number,
                     const TargetOptions& options) {
  const std::uint64_t seed = seed_of(number);
  if (options.folder.empty()) return newly_traced(stage, lights, options.noise, seed);
  const auto file =
      options.folder / fmt::format("{}_{}_{}_{}.glb", stage.file.stem().string(), stage.max_edge, options.noise, seed);
  if (!std::filesystem::exists(file)) {
    std::filesystem::create_directories(options.folder);
    inverse::save_target(newly_traced(stage, lights, options.noise, seed), file);
  }
  return inverse::load_target(file);
}

}  // namespace chiaro::benchmarks
