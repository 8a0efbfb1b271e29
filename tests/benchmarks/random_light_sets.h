#pragma once
// Random light sets and traced targets of them, for benchmarks that find the lights again.
// Lights stand in free space, at least 5 % of the scene's diagonal from each other and 3 % from surfaces; each gives at
// least 2 % of all illumination, their intensities are within a factor of 8, their colours random.

#include <filesystem>
#include <vector>

#include "inverse/target/target.h"
#include "inverse/transport/bake.h"
#include "renderer/io/load_gltf.h"

namespace chiaro::benchmarks {

// Where light sets stand.
struct Stage {
  // max_edge: of the receivers, metres; 0: from the scene's size.
  Stage(const std::filesystem::path& scene, float max_edge);

  std::filesystem::path file;
  float max_edge;
  renderer::LoadedScene loaded;
  renderer::RayTracer tracer;
  inverse::Receivers receivers, some;  // all; about a thousand of them
  inverse::LightGrid grid;
  float diagonal;  // metres
};

// A bake of all receivers, in a temporary file that goes with it.
class TemporaryBake {
 public:
  explicit TemporaryBake(const Stage& stage);
  ~TemporaryBake();
  TemporaryBake(const TemporaryBake&) = delete;
  TemporaryBake& operator=(const TemporaryBake&) = delete;

  const std::filesystem::path& file() const { return file_; }
  const inverse::BakeSettings& settings() const { return settings_; }

 private:
  inverse::BakeSettings settings_;
  std::filesystem::path file_;
};

// Which of all light sets.
struct SetNumber {
  std::uint64_t seed = 1;
  std::size_t lights = 1, set = 0;
};

std::vector<renderer::PointLight> random_lights(const Stage& stage, SetNumber number);

struct TargetOptions {
  double noise = 0.01;           // relative L2
  std::filesystem::path folder;  // keeps targets for later runs; empty: none
};

// Traced to the noise asked for, with seeds that no solver uses, unless an earlier run did it.
inverse::Target traced_target(const Stage& stage, const std::vector<renderer::PointLight>& lights, SetNumber number,
                              const TargetOptions& options);

}  // namespace chiaro::benchmarks
