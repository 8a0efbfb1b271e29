#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "inverse/target/paint.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using nlohmann::json;
using renderer::Error;

// A value of the file and where it stands, for messages.
struct Field {
  const std::string& file;
  std::string place;
  const json& value;

  [[noreturn]] void fail(std::string problem, std::string expected) const {
    throw Error({file, place, std::move(problem), std::move(expected)});
  }
  [[noreturn]] void fail_as_found(std::string expected) const { fail("is " + found(), std::move(expected)); }
  // Never the inside of arrays and objects, which may be long and deep.
  std::string found() const {
    if (value.is_structured()) return fmt::format("an {} with {} inside", value.type_name(), value.size());
    const std::string text = value.dump();
    return text.size() <= 60 ? text : fmt::format("a {} of {} characters", value.type_name(), text.size());
  }
  Field member(const std::string& name) const {
    return {file, place.empty() ? name : place + "." + name, value.at(name)};
  }
  Field element(std::size_t i) const { return {file, fmt::format("{}[{}]", place, i), value.at(i)}; }
};

void expect_object(const Field& field, std::span<const std::string_view> known,
                   std::span<const std::string_view> needed) {
  if (!field.value.is_object()) field.fail_as_found("an object");
  for (const auto& [key, value] : field.value.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    field.fail("unknown key " + json(key).dump(), fmt::format("one of {}", fmt::join(known, ", ")));
  }
  for (const std::string_view key : needed) {
    if (!field.value.contains(key)) field.fail(fmt::format("has no \"{}\"", key), fmt::format("a \"{}\"", key));
  }
}

struct Range {
  float low = std::numeric_limits<float>::lowest();
  float high = std::numeric_limits<float>::max();
};
constexpr Range kNotNegative{0, std::numeric_limits<float>::max()};
constexpr Range kPositive{std::numeric_limits<float>::min(), std::numeric_limits<float>::max()};

// A number that as a float lies in `range`; one too large for a float is infinite, and so outside.
float read_number(const Field& field, Range range, const char* expected) {
  if (!field.value.is_number()) field.fail_as_found(expected);
  const auto number = float(field.value.get<double>());
  if (!(number >= range.low && number <= range.high)) field.fail_as_found(expected);
  return number;
}

Vec3f read_triple(const Field& field, Range range, const char* expected) {
  if (!field.value.is_array() || field.value.size() != 3) field.fail_as_found(expected);
  Vec3f triple;
  for (int i = 0; i < 3; ++i) triple[i] = read_number(field.element(i), range, expected);
  return triple;
}

template <class Enum, std::size_t N>
Enum read_choice(const Field& field, const std::array<std::pair<std::string_view, Enum>, N>& choices) {
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
constexpr std::array<std::pair<std::string_view, StrokeBase>, 2> kBases{
    {{"black", StrokeBase::kBlack}, {"current", StrokeBase::kCurrent}}};

bool read_bool(const Field& field) {
  if (!field.value.is_boolean()) field.fail_as_found("true or false");
  return field.value.get<bool>();
}

std::vector<Vec3f> read_path(const Field& field) {
  if (!field.value.is_array() || field.value.empty()) field.fail_as_found("at least one point [x, y, z]");
  std::vector<Vec3f> path;
  for (std::size_t i = 0; i < field.value.size(); ++i) {
    path.push_back(read_triple(field.element(i), {}, "three finite numbers, metres"));
  }
  return path;
}

Stroke read_stroke(const Field& field) {
  static constexpr std::string_view kKnown[] = {"mode",    "color", "radius", "falloff",
                                                "opacity", "path",  "facing", "weight"};
  static constexpr std::string_view kNeeded[] = {"path"};
  expect_object(field, kKnown, kNeeded);
  const auto has = [&](const char* name) { return field.value.contains(name); };
  Stroke stroke;
  if (has("mode")) stroke.mode = read_choice(field.member("mode"), kModes);
  if (!has("color") && stroke.mode != BrushMode::kErase) field.fail("has no \"color\"", "a \"color\"");
  if (has("color")) stroke.color = read_triple(field.member("color"), kNotNegative, "three numbers ≥ 0, cd/m²");
  if (has("radius")) stroke.radius = read_number(field.member("radius"), kPositive, "a number > 0, metres");
  if (has("falloff")) stroke.falloff = read_choice(field.member("falloff"), kFalloffs);
  if (has("opacity")) stroke.opacity = read_number(field.member("opacity"), {0, 1}, "a number from 0 to 1");
  stroke.path = read_path(field.member("path"));
  if (has("facing")) stroke.facing = read_bool(field.member("facing"));
  if (has("weight")) stroke.weight = read_number(field.member("weight"), kNotNegative, "a number ≥ 0");
  return stroke;
}

Strokes read_strokes(const Field& root) {
  static constexpr std::string_view kKnown[] = {"base", "strokes"};
  static constexpr std::string_view kNeeded[] = {"strokes"};
  expect_object(root, kKnown, kNeeded);
  Strokes strokes;
  if (root.value.contains("base")) strokes.base = read_choice(root.member("base"), kBases);
  const Field list = root.member("strokes");
  if (!list.value.is_array()) list.fail_as_found("an array of strokes");
  for (std::size_t i = 0; i < list.value.size(); ++i) strokes.strokes.push_back(read_stroke(list.element(i)));
  return strokes;
}

json parse(const std::string& text, const std::string& file) {
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    // Without the library's own tag: "[json.exception.parse_error.101] parse error at line 1, column 2: …".
    const std::string_view what = error.what();
    const std::size_t tag = what.find("] ");
    throw Error({file, "", std::string(what.substr(tag == what.npos ? 0 : tag + 2)), "a stroke file in JSON"});
  }
}

}  // namespace

Strokes load_strokes(const std::filesystem::path& path) {
  const std::string file = path.string();
  const json document = parse(renderer::read_file(path), file);
  return read_strokes({file, "", document});
}

}  // namespace chiaro::inverse
