#include "cli/camera_choice.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/usage_error.h"
#include "renderer/core/error.h"
#include "renderer/trace/render.h"

namespace chiaro::cli {
namespace {

constexpr int kDefaultWidth = 960;
constexpr float kDefaultAspectRatio = 16.0F / 9.0F;
constexpr int kMaxSide = 1 << 16;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

[[noreturn]] void no_such_camera(const renderer::Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const renderer::Camera& camera : scene.cameras) names.push_back(camera.name);
  const std::string expected =
      names.empty() ? "a scene with cameras, or no name of one" : fmt::format("one of: {}", fmt::join(names, ", "));
  throw renderer::Error({scene.path, "cameras", fmt::format("no camera '{}'", name), expected});
}

int rounded(double side) { return int(std::clamp(std::round(side), 1.0, double(kMaxSide))); }

}  // namespace

renderer::Camera choose_camera(const renderer::Scene& scene, const std::string& name, const FrameSize& size,
                               Session& session) {
  if (name.empty() && !scene.cameras.empty()) return scene.cameras.front();
  const auto has_name = [&](const renderer::Camera& camera) { return camera.name == name; };
  const auto named = std::find_if(scene.cameras.begin(), scene.cameras.end(), has_name);
  if (named != scene.cameras.end()) {
    const auto count = std::count_if(named, scene.cameras.end(), has_name);
    if (count > 1)
      session.warn(fmt::format("{}: {} cameras are named '{}': taking the first", scene.path, count, name));
    return *named;
  }
  if (!name.empty()) no_such_camera(scene, name);
  session.warn(fmt::format("{}: has no camera: taking one that sees the whole scene", scene.path));
  const std::array<int, 2> pixels = frame_size({}, size);
  return renderer::default_camera(scene, float(pixels[0]) / float(pixels[1]));
}

std::array<int, 2> frame_size(const renderer::Camera& camera, const FrameSize& wanted) {
  const double aspect = camera.aspect_ratio > 0 ? camera.aspect_ratio : kDefaultAspectRatio;
  std::array<int, 2> size{};
  if (wanted.height && !wanted.width) {
    size = {rounded(*wanted.height * aspect), *wanted.height};
  } else {
    const int width = wanted.width.value_or(kDefaultWidth);
    size = {width, wanted.height ? *wanted.height : rounded(width / aspect)};
  }
  if (std::int64_t(size[0]) * size[1] > kMaxPixels) {
    throw UsageError(
        fmt::format("a frame of {} x {} pixels (expected at most {} pixels)", size[0], size[1], kMaxPixels));
  }
  return size;
}

}  // namespace chiaro::cli
