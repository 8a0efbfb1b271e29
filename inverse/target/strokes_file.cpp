#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "inverse/target/json_field.h"
#include "inverse/target/paint.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

template <class Enum, std::size_t N>
Enum read_choice(const JsonField& field, const std::array<std::pair<std::string_view, Enum>, N>& choices) {
  std::string names;
  for (const auto& [name, value] : choices) {
    if (field.value.is_string() && field.value.get_ref<const std::string&>() == name) return value;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  field.fail_as_found("one of " + names);
}

constexpr std::array<std::pair<std::string_view, BrushMode>, 4> kModes{{{"add", BrushMode::kAdd},
                                                                        {"set", BrushMode::kSet},
                                                                        {"multiply", BrushMode::kMultiply},
                                                                        {"erase", BrushMode::kErase}}};
constexpr std::array<std::pair<std::string_view, BrushFalloff>, 3> kFalloffs{
    {{"smooth", BrushFalloff::kSmooth}, {"hard", BrushFalloff::kHard}, {"gaussian", BrushFalloff::kGaussian}}};
constexpr std::array<std::pair<std::string_view, BrushDistance>, 2> kDistances{
    {{"surface", BrushDistance::kSurface}, {"space", BrushDistance::kSpace}}};
constexpr std::array<std::pair<std::string_view, MirrorPlane>, 3> kMirrors{
    {{"x", {{0, 0, 0}, {1, 0, 0}}}, {"y", {{0, 0, 0}, {0, 1, 0}}}, {"z", {{0, 0, 0}, {0, 0, 1}}}}};
constexpr std::array<std::pair<std::string_view, StrokeBase>, 2> kBases{
    {{"black", StrokeBase::kBlack}, {"current", StrokeBase::kCurrent}}};

std::vector<Vec3f> read_path(const JsonField& field) {
  if (!field.value.is_array() || field.value.empty()) field.fail_as_found("at least one point [x, y, z]");
  std::vector<Vec3f> path;
  for (std::size_t i = 0; i < field.value.size(); ++i) {
    path.push_back(read_triple(field.element(i), {}, "three finite numbers, metres"));
  }
  return path;
}

// Of a vector so short or long that its square is no float, too.
Vec3f read_direction(const JsonField& field) {
  const Vec3f direction = read_triple(field, {}, "three numbers, not all 0");
  const float largest = max_component(abs(direction));
  if (!(largest > 0)) field.fail("is [0, 0, 0]", "three numbers, not all 0");
  return normalize(Vec3f{direction.x / largest, direction.y / largest, direction.z / largest});
}

MirrorPlane read_mirror(const JsonField& field) {
  static constexpr std::string_view kKnown[] = {"point", "normal"};
  static constexpr std::string_view kNeeded[] = {"normal"};
  if (field.value.is_string()) return read_choice(field, kMirrors);
  if (!field.value.is_object()) field.fail_as_found(R"("x", "y", "z" or an object with "point" and "normal")");
  expect_object(field, kKnown, kNeeded);
  MirrorPlane plane;
  plane.normal = read_direction(field.member("normal"));
  if (field.has("point")) plane.point = read_triple(field.member("point"), {}, "three finite numbers, metres");
  return plane;
}

Vec3f read_color(const JsonField& field) {
  static const std::string expected = fmt::format("three numbers from 0 to {:g}, cd/m²", renderer::kBrightest);
  return read_triple(field, {0, renderer::kBrightest}, expected.c_str());
}

Stroke read_stroke(const JsonField& field) {
  static constexpr std::string_view kKnown[] = {"mode", "color",    "radius", "falloff", "opacity",
                                                "path", "distance", "mirror", "facing",  "weight"};
  static constexpr std::string_view kNeeded[] = {"path"};
  expect_object(field, kKnown, kNeeded);
  const auto has = [&](const char* name) { return field.has(name); };
  Stroke stroke;
  if (has("mode")) stroke.mode = read_choice(field.member("mode"), kModes);
  if (!has("color") && stroke.mode != BrushMode::kErase) field.fail("has no \"color\"", "a \"color\"");
  if (has("color")) stroke.color = read_color(field.member("color"));
  if (has("radius")) stroke.radius = read_number(field.member("radius"), kPositive, "a number > 0, metres");
  if (has("falloff")) stroke.falloff = read_choice(field.member("falloff"), kFalloffs);
  if (has("opacity")) stroke.opacity = read_number(field.member("opacity"), {0, 1}, "a number from 0 to 1");
  stroke.path = read_path(field.member("path"));
  if (has("distance")) stroke.distance = read_choice(field.member("distance"), kDistances);
  if (has("mirror")) stroke.mirror = read_mirror(field.member("mirror"));
  if (has("facing")) stroke.facing = read_bool(field.member("facing"));
  if (has("weight")) stroke.weight = read_number(field.member("weight"), kNotNegative, "a number ≥ 0");
  return stroke;
}

Strokes read_strokes(const JsonField& root) {
  static constexpr std::string_view kKnown[] = {"base", "strokes"};
  static constexpr std::string_view kNeeded[] = {"strokes"};
  expect_object(root, kKnown, kNeeded);
  Strokes strokes;
  if (root.has("base")) strokes.base = read_choice(root.member("base"), kBases);
  const JsonField list = root.member("strokes");
  if (!list.value.is_array()) list.fail_as_found("an array of strokes");
  for (std::size_t i = 0; i < list.value.size(); ++i) strokes.strokes.push_back(read_stroke(list.element(i)));
  return strokes;
}

}  // namespace

Strokes load_strokes(const std::filesystem::path& path) {
  return read_json_file(path, "a stroke file in JSON", read_strokes);
}

}  // namespace chiaro::inverse
