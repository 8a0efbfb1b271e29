#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/inspect.h"
#include "inverse/target/paint.h"
#include "renderer/core/counted.h"
#include "renderer/io/light_file.h"

namespace chiaro::cli {
namespace {

const char* name_of_mode(inverse::BrushMode mode) {
  switch (mode) {
    case inverse::BrushMode::kAdd:
      return "add";
    case inverse::BrushMode::kSet:
      return "set";
    case inverse::BrushMode::kMultiply:
      return "multiply";
    case inverse::BrushMode::kErase:
      break;
  }
  return "erase";
}

// Factors of what is there already have no unit, and what is erased has no colour.
std::string text_of_color(const inverse::Stroke& stroke) {
  if (stroke.mode == inverse::BrushMode::kErase) return "";
  const char* unit = stroke.mode == inverse::BrushMode::kMultiply ? "" : " cd/m²";
  return fmt::format(", {}{}", text_of_vector(stroke.color), unit);
}

}  // namespace

void Inspection::add(const std::string& key, Json value, const std::string& label, const std::string& text) {
  summary.emplace_back(key, std::move(value));
  rows.emplace_back(label, text);
}

Inspection start_inspection(const std::string& kind, const std::string& file) {
  Inspection inspection;
  inspection.add("kind", kind, "kind", kind);
  inspection.add("file", file, "file", file);
  return inspection;
}

void add_variants(Inspection& inspection, const std::vector<std::string>& variants) {
  inspection.summary.emplace_back("variants", json_list(variants));
  if (!variants.empty()) inspection.rows.emplace_back("variants", fmt::format("{}", fmt::join(variants, ", ")));
}

Inspection inspect_light_file(const std::string& file) {
  Inspection inspection = start_inspection("light file", file);
  add_lights(inspection, renderer::load_lights(file, inspection.warnings));
  return inspection;
}

Inspection inspect_strokes(const std::string& file) {
  const inverse::Strokes strokes = inverse::load_strokes(file);
  Inspection inspection = start_inspection("strokes", file);
  const std::string base = strokes.base == inverse::StrokeBase::kBlack ? "black" : "current";
  inspection.add("base", base, "base", base);
  JsonList list;
  for (const inverse::Stroke& stroke : strokes.strokes) {
    const std::string mode = name_of_mode(stroke.mode);
    list.emplace_back(
        JsonObject{{"mode", mode}, {"color", stroke.color}, {"radius", stroke.radius}, {"points", stroke.path.size()}});
    inspection.rows.emplace_back("stroke",
                                 fmt::format("{}, radius {:.4g} m, {}", mode + text_of_color(stroke), stroke.radius,
                                             renderer::counted(stroke.path.size(), "point", "points")));
  }
  inspection.summary.emplace_back("strokes", list);
  return inspection;
}

}  // namespace chiaro::cli
