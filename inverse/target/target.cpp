#include "inverse/target/target.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

using renderer::Error;
using renderer::VertexMesh;
using renderer::VertexMeshPart;

bool has_values(const VertexMeshPart& part) { return !part.illumination.empty() || !part.color.empty(); }

[[noreturn]] void fail_at_vertex(const std::string& file, const VertexMeshPart& part, std::size_t vertex,
                                 const char* problem, const std::string& expected) {
  throw Error({file, fmt::format("node \"{}\", vertex {}", part.name, vertex), problem, expected});
}

// Of what is read and of what is written: no file of ours is refused later.
void check_illumination(const std::string& file, const VertexMeshPart& part, std::size_t vertex, Vec3f value) {
  if (renderer::is_light(value)) return;
  fail_at_vertex(file, part, vertex, "illumination is negative or too large",
                 fmt::format("0 to {:g} cd/m²", renderer::kBrightest));
}

Vec3f wanted_value(const VertexMeshPart& part, std::size_t vertex, float target_scale) {
  if (!part.illumination.empty()) return part.illumination[vertex];
  return part.color.empty() ? Vec3f{} : target_scale * part.color[vertex];
}

// Nothing is wanted of a part without values: its weight is 0.
float wanted_weight(const VertexMeshPart& part, std::size_t vertex) {
  if (!has_values(part)) return 0;
  return part.weight.empty() ? 1 : part.weight[vertex];
}

bool has_colors_alone(const VertexMeshPart& part) { return part.illumination.empty() && !part.color.empty(); }

void append_part(Target& target, const VertexMeshPart& part, float target_scale, const std::string& file) {
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    const Vec3f value = wanted_value(part, i, target_scale);
    check_illumination(file, part, i, value);
    target.illumination.push_back(value);
    target.weight.push_back(wanted_weight(part, i));
  }
}

bool all_know_their_error(const VertexMesh& mesh) {
  return std::all_of(mesh.parts.begin(), mesh.parts.end(), [](const VertexMeshPart& part) {
    return part.positions.empty() || !has_values(part) || !part.standard_error.empty();
  });
}

void append_standard_error(Target& target, const VertexMeshPart& part, const std::string& file) {
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    const float error = part.standard_error.empty() ? 0 : part.standard_error[i];
    if (!(error >= 0)) fail_at_vertex(file, part, i, "_STANDARD_ERROR is negative", "finite numbers ≥ 0");
    target.standard_error.push_back(error);
  }
}

void check_not_black(const Target& target, const std::string& file) {
  require_weight(target, file);
  if (wants_light(target)) return;
  throw Error({file, "", "an empty target: black, or all but, wherever its weight is not 0",
               fmt::format("illumination of {:g} cd/m² or more somewhere", kDimmest)});
}

void check_scale(float target_scale) {
  if (std::isfinite(target_scale) && target_scale > 0) return;
  throw Error({"", "option --target-scale", fmt::format("is {}", target_scale), "a number > 0, cd/m²"});
}

// The illumination that programs which show COLOR_0 draw as white: all but the brightest hundredth is below.
float display_white(const Target& target) {
  std::vector<float> brightness;
  for (const Vec3f value : target.illumination) {
    if (max_component(value) > 0) brightness.push_back(max_component(value));
  }
  if (brightness.empty()) return 1;
  const auto rank = brightness.begin() + std::ptrdiff_t((brightness.size() - 1) * 99 / 100);
  std::nth_element(brightness.begin(), rank, brightness.end());
  return *rank;
}

template <class T>
std::vector<T> slice(const std::vector<T>& values, std::size_t first, std::size_t count) {
  if (values.empty()) return {};
  return {values.begin() + std::ptrdiff_t(first), values.begin() + std::ptrdiff_t(first + count)};
}

}  // namespace

void require_weight(const Target& target, const std::string& file) {
  const auto& weight = target.weight;
  if (std::any_of(weight.begin(), weight.end(), [](float w) { return w > 0; })) return;
  throw Error({file, "", "an empty target: every _WEIGHT is 0", "a weight > 0 somewhere"});
}

bool wants_light(const Target& target) {
  for (std::size_t i = 0; i < target.weight.size(); ++i) {
    if (target.weight[i] > 0 && max_component(target.illumination[i]) >= kDimmest) return true;
  }
  return false;
}

Target load_target(const std::filesystem::path& path, float target_scale) {
  Target target = load_illumination(path, target_scale);
  check_not_black(target, path.string());
  return target;
}

Target load_illumination(const std::filesystem::path& path, float target_scale) {
  check_scale(target_scale);
  const std::string file = path.string();
  const VertexMesh mesh = renderer::load_vertex_mesh(path);
  Target target;
  for (const VertexMeshPart& part : mesh.parts) append_part(target, part, target_scale, file);
  if (std::none_of(mesh.parts.begin(), mesh.parts.end(), has_values)) {
    throw Error({file, "", "an empty target: no primitive has illumination", "vertices with _ILLUMINATION or COLOR_0"});
  }
  target.warnings = mesh.warnings;
  target.has_scaled_colors = std::any_of(mesh.parts.begin(), mesh.parts.end(), has_colors_alone);
  if (all_know_their_error(mesh)) {
    for (const VertexMeshPart& part : mesh.parts) append_standard_error(target, part, file);
  }
  target.receivers = receivers_from_mesh(mesh);
  CHIARO_CHECK(target.receivers.size() == target.illumination.size());
  return target;
}

void save_target(const Target& target, const std::filesystem::path& path) {
  CHIARO_CHECK(target.illumination.size() == target.receivers.size());
  CHIARO_CHECK(target.weight.size() == target.receivers.size());
  CHIARO_CHECK(target.standard_error.empty() || target.standard_error.size() == target.receivers.size());
  VertexMesh mesh = mesh_from_receivers(target.receivers);
  std::size_t first = 0;
  for (VertexMeshPart& part : mesh.parts) {
    const std::size_t count = part.positions.size();
    part.illumination = slice(target.illumination, first, count);
    for (std::size_t i = 0; i < count; ++i) check_illumination(path.string(), part, i, part.illumination[i]);
    part.weight = slice(target.weight, first, count);
    part.standard_error = slice(target.standard_error, first, count);
    first += count;
  }
  CHIARO_CHECK(first == target.receivers.size());
  renderer::save_vertex_mesh(mesh, path, display_white(target));
}

std::vector<float> standard_error_per_receiver(const renderer::Illumination& illumination) {
  std::vector<float> errors;
  for (const Vec3f error : illumination.standard_error) errors.push_back(float(std::sqrt(squared_norm(error) / 3)));
  return errors;
}

// A reference of zero length: 0 if `a` is zero too, else infinite.
double relative_l2(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b, const std::vector<float>& weight) {
  CHIARO_CHECK(a.size() == b.size() && a.size() == weight.size());
  double difference = 0, reference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double d = double(a[i][c]) - b[i][c];
      difference += weight[i] * d * d;
      reference += weight[i] * double(b[i][c]) * b[i][c];
    }
  }
  return difference > 0 ? std::sqrt(difference / reference) : 0;
}

}  // namespace chiaro::inverse
