#include "tests/benchmarks/random_constraints.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "renderer/core/sampler.h"

namespace chiaro::benchmarks {
namespace {

using inverse::LightConstraints;
using renderer::Box3f;
using renderer::Vec3f;

constexpr double kOften = 0.3;       // each constraint
constexpr double kSometimes = 0.15;  // those that leave little to others
constexpr double kRarely = 0.05;     // what cannot be
constexpr double kLeastMired = 1e6 / 25000, kMostMired = 1e6 / 1667;

class RandomCase {
 public:
  RandomCase(const Stage& stage, std::uint64_t seed, std::size_t number)
      : stage_(stage), numbers_(seed, 1, std::uint32_t(number)), bounds_(stage.tracer.bounds()) {
    case_.number = number;
  }

  ConstraintCase draw() {
    draw_method();
    draw_regions();
    LightConstraints& c = case_.constraints;
    if (happens(kOften)) c.surface_distance = double(stage_.diagonal) * power_of_ten(-3, -0.2);
    if (joint() && happens(kOften)) c.light_distance = double(stage_.diagonal) * power_of_ten(-2.5, 0.1);
    if (joint() && happens(kOften)) c.max_intensity = power_of_ten(-1, 2);
    if (joint() && happens(kOften)) draw_kelvin();
    c.one_color = joint() && happens(kOften);
    draw_counts();
    draw_scene_lights();
    return case_;
  }

 private:
  double uniform() { return double(numbers_.next_1d()); }
  bool happens(double probability) { return uniform() < probability; }
  int whole(int low, int high) { return low + int(uniform() * (high - low + 1)); }
  double power_of_ten(double low, double high) { return std::pow(10.0, low + (high - low) * uniform()); }
  bool joint() const { return case_.method == inverse::SolveMethod::kJoint; }
  Vec3f anywhere() { return inverse::random_position(bounds_, numbers_); }

  void draw_method() { case_.method = happens(0.1) ? inverse::SolveMethod::kThesis : inverse::SolveMethod::kJoint; }

  const std::string& random_node() {
    const auto& instances = stage_.loaded.scene.instances;
    return instances[std::size_t(whole(0, int(instances.size()) - 1))].name;
  }

  // Small or large, sometimes flat, and rarely outside the scene.
  std::string random_box() {
    Vec3f center = anywhere();
    if (happens(kRarely)) center = center + 3.0F * bounds_.extent();
    Vec3f half;
    for (int a = 0; a < 3; ++a) half[a] = happens(kRarely) ? 0 : bounds_.extent()[a] * float(power_of_ten(-2, -0.3));
    const Vec3f low = center - half, high = center + half;
    return fmt::format("{},{},{},{},{},{}", low.x, low.y, low.z, high.x, high.y, high.z);
  }

  void draw_regions() {
    LightConstraints& c = case_.constraints;
    for (int k = happens(kOften) ? whole(1, 3) : 0; k > 0; --k) {
      c.regions.push_back({happens(0.2) ? random_node() : random_box()});
    }
    for (int k = happens(kOften) ? whole(1, 2) : 0; k > 0; --k) {
      inverse::Mount& mount = c.mounts.emplace_back(inverse::Mount{random_node()});
      if (happens(0.7)) mount.clearance = double(stage_.diagonal) * power_of_ten(-3.5, -0.7);
      if (happens(kRarely)) mount.clearance = 0;
    }
  }

  void draw_kelvin() {
    const double a = 1e6 / (kLeastMired + uniform() * (kMostMired - kLeastMired));
    const double b = happens(0.2) ? a : 1e6 / (kLeastMired + uniform() * (kMostMired - kLeastMired));
    case_.constraints.kelvin = {std::round(std::min(a, b)), std::round(std::max(a, b))};
  }

  void draw_counts() {
    LightConstraints& c = case_.constraints;
    if (happens(kOften)) c.lights = whole(1, 5);
    if (happens(kOften)) c.max_lights = whole(1, 5);
    if (c.lights && c.max_lights && !happens(kRarely)) c.max_lights = std::max(*c.max_lights, *c.lights);
  }

  // Fainter than those that made the target.
  Vec3f faint() { return {0.2F + float(uniform()), 0.2F + float(uniform()), 0.2F + float(uniform())}; }
  renderer::Light random_light() {
    const Vec3f direction = normalize(anywhere() - bounds_.center() + Vec3f{0, 1e-3F, 0});
    switch (whole(0, 3)) {
      case 0:
        return renderer::SpotLight{"", anywhere(), direction, faint(), 0.2F, 0.7F};
      case 1:
        return renderer::DirectionalLight{"", direction, 0.1F * faint()};
      default:
        return renderer::PointLight{"", anywhere(), faint()};
    }
  }

  void draw_scene_lights() {
    LightConstraints& c = case_.constraints;
    c.keep_lights = happens(kSometimes);
    c.keep_positions = !c.keep_lights && joint() && happens(kSometimes);
    if (c.keep_positions && !happens(kRarely)) c.lights = c.max_lights = std::nullopt;
    for (int k = c.keep_lights || c.keep_positions ? whole(1, 4) : 0; k > 0; --k) {
      case_.scene_lights.push_back(random_light());
    }
  }

  const Stage& stage_;
  renderer::Sampler numbers_;
  Box3f bounds_;
  ConstraintCase case_;
};

std::string json_of(const inverse::Mount& mount) {
  if (!mount.clearance) return fmt::format(R"({{"on":"{}"}})", mount.node);
  return fmt::format(R"({{"on":"{}","clearance":{}}})", mount.node, *mount.clearance);
}

bool is_box(const std::string& region) { return std::count(region.begin(), region.end(), ',') == 5; }

}  // namespace

ConstraintCase random_case(const Stage& stage, std::uint64_t seed, std::size_t number) {
  return RandomCase(stage, seed, number).draw();
}

std::string json_of(const LightConstraints& c) {
  std::vector<std::string> fields, regions;
  const auto add = [&](const char* name, const auto& value) {
    if (value) fields.push_back(fmt::format(R"("{}":{})", name, *value));
  };
  const auto flag = [&](const char* name, bool value) {
    if (value) fields.push_back(fmt::format(R"("{}":true)", name));
  };
  for (const auto& [text, asked_in] : c.regions) {
    regions.push_back(is_box(text) ? fmt::format("[{}]", text) : fmt::format("\"{}\"", text));
  }
  for (const inverse::Mount& mount : c.mounts) regions.push_back(json_of(mount));
  if (!regions.empty()) fields.push_back(fmt::format(R"("regions":[{}])", fmt::join(regions, ",")));
  if (c.kelvin) fields.push_back(fmt::format(R"("kelvin":[{},{}])", (*c.kelvin)[0], (*c.kelvin)[1]));
  add("lights", c.lights);
  add("max_lights", c.max_lights);
  add("surface_distance", c.surface_distance);
  add("light_distance", c.light_distance);
  add("max_intensity", c.max_intensity);
  flag("one_color", c.one_color);
  flag("keep_lights", c.keep_lights);
  flag("keep_positions", c.keep_positions);
  return fmt::format("{{{}}}", fmt::join(fields, ","));
}

}  // namespace chiaro::benchmarks
