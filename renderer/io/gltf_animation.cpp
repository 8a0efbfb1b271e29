#include "renderer/io/gltf_animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/error.h"
#include "renderer/io/gltf_accessors.h"

namespace chiaro::renderer {
namespace {

constexpr int kQuaternion = 4;

struct Keys {
  std::vector<float> times;   // seconds, never decreasing: exporters repeat some
  std::vector<float> values;  // `width` each; three times as many with cubic splines: in-tangent, value, out-tangent
  std::size_t width = 0;
  bool cubic = false, step = false;

  const float* value(std::size_t key) const { return &values[(cubic ? 3 * key + 1 : key) * width]; }
  const float* in_tangent(std::size_t key) const { return &values[3 * key * width]; }
  const float* out_tangent(std::size_t key) const { return &values[(3 * key + 2) * width]; }
};

using Values = std::vector<float>;

Values copy_of(const float* first, std::size_t count) { return {first, first + count}; }

using Quaternion = std::array<double, kQuaternion>;

Quaternion unit(const float* q) {
  const double length = std::hypot(std::hypot(double(q[0]), double(q[1])), std::hypot(double(q[2]), double(q[3])));
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

// Ken Shoemake, Animating rotation with quaternion curves, 1985; along the shorter arc.
Values slerp(const Quaternion& a, const Quaternion& b, double t) {
  double cosine = 0;
  for (std::size_t i = 0; i < kQuaternion; ++i) cosine += a[i] * b[i];
  const double sign = cosine < 0 ? -1 : 1;
  const double angle = std::acos(std::min(std::abs(cosine), 1.0)), sine = std::sin(angle);
  const bool straight = sine < 1e-6;
  const double from = straight ? 1 - t : std::sin((1 - t) * angle) / sine;
  const double to = sign * (straight ? t : std::sin(t * angle) / sine);
  Values result(kQuaternion);
  for (std::size_t i = 0; i < kQuaternion; ++i) result[i] = float(from * a[i] + to * b[i]);
  return result;
}

Values linear(const float* a, const float* b, std::size_t width, double t) {
  Values result(width);
  for (std::size_t i = 0; i < width; ++i) result[i] = float((1 - t) * a[i] + t * b[i]);
  return result;
}

// glTF 2.0, appendix C.5; tangents are per second.
Values cubic(const Keys& keys, std::size_t key, double t) {
  const double span = double(keys.times[key + 1]) - keys.times[key], t2 = t * t, t3 = t2 * t;
  Values result(keys.width);
  for (std::size_t i = 0; i < keys.width; ++i) {
    result[i] = float((2 * t3 - 3 * t2 + 1) * keys.value(key)[i] + span * (t3 - 2 * t2 + t) * keys.out_tangent(key)[i] +
                      (3 * t2 - 2 * t3) * keys.value(key + 1)[i] + span * (t3 - t2) * keys.in_tangent(key + 1)[i]);
  }
  return result;
}

Values sample(const Keys& keys, double seconds, bool rotation) {
  const std::vector<float>& times = keys.times;
  const auto later = std::upper_bound(times.begin(), times.end(), seconds);
  if (later == times.begin()) return copy_of(keys.value(0), keys.width);
  const auto key = std::size_t(later - times.begin()) - 1;
  if (later == times.end() || keys.step) return copy_of(keys.value(key), keys.width);
  const double t = (seconds - times[key]) / (double(times[key + 1]) - times[key]);
  if (keys.cubic) return cubic(keys, key, t);
  return rotation ? slerp(unit(keys.value(key)), unit(keys.value(key + 1)), t)
                  : linear(keys.value(key), keys.value(key + 1), keys.width, t);
}

// One animation as it is read.
class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, int animation) : document_(document), animation_(animation) {}

  // Sets what its channels move.
  void pose(double seconds, GltfPose& pose, std::vector<std::string>& warnings) const {
    const GltfAnimation& animation = document_.json.animations[std::size_t(animation_)];
    for (std::size_t c = 0; c < animation.channels.size(); ++c) {
      const GltfAnimationChannel& channel = animation.channels[c];
      const std::string place = fmt::format("animations[{}].channels[{}]", animation_, c);
      if (channel.node < 0) {
        // What it moves is no node.
        if (channel.path == "pointer") warnings.push_back(place + ": \"pointer\" is not animated here");
        continue;
      }
      if (is_moved(channel, place, warnings)) set(channel, place, seconds, pose[channel.node]);
    }
  }

 private:
  bool is_moved(const GltfAnimationChannel& channel, const std::string& place,
                std::vector<std::string>& warnings) const {
    const tinygltf::Node& node = document_.model->nodes[std::size_t(channel.node)];
    const bool known = channel.path == "translation" || channel.path == "rotation" || channel.path == "scale" ||
                       channel.path == "weights";
    if (!known) warnings.push_back(fmt::format("{}: \"{}\" is not animated here", place, channel.path.substr(0, 40)));
    const bool has_matrix = !node.matrix.empty() && channel.path != "weights";
    if (has_matrix) warnings.push_back(fmt::format("{}: nodes[{}] has a matrix and stays", place, channel.node));
    return known && !has_matrix;
  }

  std::size_t width_of(const GltfAnimationChannel& channel, std::size_t keys, std::size_t values) const {
    if (channel.path == "rotation") return kQuaternion;
    if (channel.path != "weights") return 3;
    return keys == 0 ? 0 : values / keys;
  }

  Keys read_keys(const GltfAnimationChannel& channel, const std::string& place) const {
    const GltfAnimation& animation = document_.json.animations[std::size_t(animation_)];
    const GltfAnimationSampler& sampler = animation.samplers[std::size_t(channel.sampler)];
    Keys keys;
    keys.cubic = sampler.interpolation == "CUBICSPLINE";
    keys.step = sampler.interpolation == "STEP";
    if (!keys.cubic && !keys.step && sampler.interpolation != "LINEAR") {
      fail(document_, place, fmt::format("interpolation is \"{}\"", sampler.interpolation.substr(0, 40)),
           "LINEAR, STEP or CUBICSPLINE");
    }
    keys.times = read_floats(document_, sampler.input, 1, place + ".input");
    const int components = channel.path == "rotation" ? kQuaternion : channel.path == "weights" ? 1 : 3;
    keys.values = read_floats(document_, sampler.output, components, place + ".output");
    const std::size_t keyed = keys.times.size() * (keys.cubic ? 3 : 1);
    keys.width = width_of(channel, keyed, keys.values.size());
    check(keys, keyed, place);
    if (channel.path == "rotation") check_rotations(keys, place);
    return keys;
  }

  void check(const Keys& keys, std::size_t keyed, const std::string& place) const {
    if (keyed == 0 || keys.width == 0 || keys.values.size() != keyed * keys.width) {
      fail(document_, place + ".output", fmt::format("has {} values", keys.values.size()),
           fmt::format("as many as {} keys need", keys.times.size()));
    }
    const auto finite = [](float v) { return std::isfinite(v); };
    if (!std::all_of(keys.values.begin(), keys.values.end(), finite) ||
        !std::all_of(keys.times.begin(), keys.times.end(), finite)) {
      fail(document_, place, "its keys are not finite", "finite numbers");
    }
    if (std::adjacent_find(keys.times.begin(), keys.times.end(), std::greater<>()) != keys.times.end()) {
      fail(document_, place + ".input", "its times run back", "each no earlier than the one before");
    }
  }

  void check_rotations(const Keys& keys, const std::string& place) const {
    for (std::size_t key = 0; key < keys.times.size(); ++key) {
      const float* const q = keys.value(key);
      if (std::any_of(q, q + kQuaternion, [](float v) { return v != 0; })) continue;
      fail(document_, place + ".output", fmt::format("its rotation {} is of no direction", key), "unit quaternions");
    }
  }

  void set(const GltfAnimationChannel& channel, const std::string& place, double seconds, NodePose& pose) const {
    const Values v = sample(read_keys(channel, place), seconds, channel.path == "rotation");
    if (channel.path == "translation") pose.translation = Vec3f{v[0], v[1], v[2]};
    if (channel.path == "scale") pose.scale = Vec3f{v[0], v[1], v[2]};
    if (channel.path == "rotation") pose.rotation = Vec4f{v[0], v[1], v[2], v[3]};
    if (channel.path == "weights") pose.weights = v;
  }

  const GltfDocument& document_;
  int animation_;
};

// Which there are, by their numbers and names.
std::string text_of_choices(const std::vector<GltfAnimation>& animations) {
  if (animations.empty()) return "none: the file has no animation";
  std::string names;
  for (const GltfAnimation& animation : animations) {
    if (!animation.name.empty()) names += (names.empty() ? "" : ", ") + animation.name;
  }
  const std::string numbers = animations.size() == 1 ? "0" : fmt::format("0 to {}", animations.size() - 1);
  return names.empty() ? numbers : fmt::format("{}, or: {}", numbers, names);
}

std::vector<int> named(const GltfDocument& document, const std::string& name) {
  const std::vector<GltfAnimation>& animations = document.json.animations;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    if (animations[i].name == name) return {int(i)};
  }
  for (std::size_t i = 0; i < animations.size(); ++i) {
    if (std::to_string(i) == name) return {int(i)};
  }
  fail(document, "animations", fmt::format("none is \"{}\"", name.substr(0, 80)), text_of_choices(animations));
}

std::vector<int> those_that_play(const GltfDocument& document, std::vector<std::string>& warnings) {
  std::set<std::pair<int, std::string>> moved;
  std::vector<int> all;
  for (std::size_t a = 0; a < document.json.animations.size(); ++a) {
    std::set<std::pair<int, std::string>> own;
    for (const auto& channel : document.json.animations[a].channels) own.emplace(channel.node, channel.path);
    for (const auto& target : own) {
      if (target.first < 0 || moved.insert(target).second) continue;
      warnings.push_back(fmt::format("animations move the same nodes: the first of {} plays, or the one named",
                                     document.json.animations.size()));
      return {0};
    }
    all.push_back(int(a));
  }
  return all;
}

}  // namespace

GltfPose pose_at(const GltfDocument& document, const AnimationChoice& choice, std::vector<std::string>& warnings) {
  std::vector<int> animations;
  if (!choice.animation.empty()) animations = named(document, choice.animation);
  if (!choice.seconds) return {};
  if (choice.animation.empty()) animations = those_that_play(document, warnings);
  if (animations.empty()) warnings.push_back("there is no animation to play");
  GltfPose pose;
  for (const int a : animations) AnimationReader(document, a).pose(*choice.seconds, pose, warnings);
  return pose;
}

}  // namespace chiaro::renderer
