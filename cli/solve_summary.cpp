#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/solve_options.h"
#include "cli/text_output.h"
#include "inverse/solve/not_told_apart.h"

namespace chiaro::cli {
namespace {

constexpr double kMostPercent = 10;  // times what was wanted: more is not told in percent

// As in a light file.
JsonObject light_fields(const renderer::PointLight& light) {
  return {{"type", "point"}, {"name", light.name}, {"position", light.position}, {"intensity", light.intensity}};
}
JsonObject light_fields(const renderer::SpotLight& light) {
  return {{"type", "spot"},
          {"name", light.name},
          {"position", light.position},
          {"direction", light.direction},
          {"intensity", light.intensity},
          {"inner_cone_angle", light.inner_cone_angle},
          {"outer_cone_angle", light.outer_cone_angle}};
}
JsonObject light_fields(const renderer::DirectionalLight& light) {
  return {
      {"type", "directional"}, {"name", light.name}, {"direction", light.direction}, {"intensity", light.illuminance}};
}
JsonObject light_fields(const renderer::EnvironmentLight& light) {
  return {{"type", "environment"}, {"name", light.name}};
}

JsonObject light_summary(const inverse::FoundLight& found) {
  JsonObject summary = std::visit([](const auto& light) { return light_fields(light); }, found.light);
  std::erase_if(summary,
                [&](const auto& field) { return field.first == "name" && renderer::name_of(found.light).empty(); });
  summary.emplace_back("contribution", found.contribution);
  summary.emplace_back("interval_90",
                       JsonObject{{"position", found.position_interval}, {"intensity", found.intensity_interval}});
  return summary;
}

JsonObject curve_point(const inverse::LightSet& set) {
  JsonList lights;
  for (const renderer::PointLight& light : set.lights) {
    lights.emplace_back(JsonObject{{"type", "point"}, {"position", light.position}, {"intensity", light.intensity}});
  }
  return {{"light_count", set.lights.size()}, {"relative_l2", set.relative_l2}, {"lights", lights}};
}

JsonObject place_summary(const inverse::NotReached& place) {
  JsonObject summary{{"node", place.node}, {"position", place.position}, {"share_of_error", place.share}};
  if (place.wanted > 0) summary.emplace_back("relative_excess", place.excess / place.wanted);
  if (place.other_color) summary.emplace_back("other_color", true);
  return summary;
}

std::string text_of_places(const std::vector<inverse::NotReached>& places) {
  std::vector<std::string> texts;
  for (const inverse::NotReached& place : places) texts.push_back(text_of_place(place));
  return fmt::format("{}", fmt::join(texts, "; "));
}

JsonObject stage_summary(const inverse::StageReport& stage) {
  JsonObject summary{{"name", stage.name}, {"seconds", stage.seconds}};
  for (const auto& [name, figure] : stage.figures) summary.emplace_back(name, figure);
  return summary;
}

// "1: 54.5 %, 2: 40.1 %"
std::string text_of_curve(const std::vector<inverse::LightSet>& curve) {
  std::vector<std::string> points;
  for (const inverse::LightSet& set : curve) {
    points.push_back(fmt::format("{}: {}", set.lights.size(), text_of_percent(set.relative_l2)));
  }
  return fmt::format("{}", fmt::join(points, ", "));
}

using PlaceAndBrightness = std::pair<std::string, std::string>;
PlaceAndBrightness place_and_brightness(const renderer::DirectionalLight& light) {
  return {"from afar", text_of_vector(light.illuminance) + " lx"};
}
PlaceAndBrightness place_and_brightness(const renderer::EnvironmentLight&) { return {"all around", ""}; }
PlaceAndBrightness place_and_brightness(const auto& light) {
  return {text_of_vector(light.position), text_of_vector(light.intensity)};
}

std::string light_table(const std::vector<inverse::FoundLight>& lights) {
  std::vector<std::vector<std::string>> rows{
      {"light", "position (m)", "± 90 %", "intensity (cd)", "± 90 %", "contribution"}};
  for (const inverse::FoundLight& found : lights) {
    const auto [position, intensity] =
        std::visit([](const auto& light) { return place_and_brightness(light); }, found.light);
    rows.push_back({fmt::format("{}", rows.size()), position, text_of_interval(found.position_interval), intensity,
                    text_of_interval(found.intensity_interval), text_of_percent(found.contribution)});
  }
  return table(rows);
}

}  // namespace

JsonObject solve_summary(const inverse::SolveResult& result) {
  JsonList lights, curve, stages, places, pairs;
  for (const inverse::NotReached& place : result.not_reached) places.emplace_back(place_summary(place));
  for (const auto& [one, other] : result.not_told_apart) pairs.emplace_back(JsonList{Json(one), Json(other)});
  for (const inverse::FoundLight& found : result.lights) lights.emplace_back(light_summary(found));
  for (const inverse::LightSet& set : result.error_curve) curve.emplace_back(curve_point(set));
  for (const inverse::StageReport& stage : result.stages) stages.emplace_back(stage_summary(stage));
  return {{"light_count", result.lights.size()},
          {"lights", lights},
          {"error", JsonObject{{"relative_l2", result.relative_l2},
                               {"relative_l2_cached", result.relative_l2_cached},
                               {"initial_relative_l2", result.initial_relative_l2}}},
          {"error_curve", curve},
          {"seconds", JsonObject{{"total", result.total_seconds},
                                 {"initial", result.initial_seconds},
                                 {"optimal", result.optimal_seconds},
                                 {"cache", result.cache_seconds}}},
          {"stages", stages},
          {"important_vertices", result.important_vertices},
          {"target_noise", result.target_noise},
          {"verification_noise", result.verification_noise},
          {"not_told_apart", pairs},
          {"not_reached", places},
          {"advice", result.advice},
          {"termination", inverse::words_for(result.termination)}};
}

std::string text_of_place(const inverse::NotReached& place) {
  const std::string by = place.wanted > 0 && std::abs(place.excess) < kMostPercent * place.wanted
                             ? text_of_percent(std::abs(place.excess) / place.wanted) + " too "
                             : "far too ";
  const std::string what =
      place.other_color ? "has another colour" : "is " + by + (place.excess < 0 ? "dark" : "bright");
  return fmt::format("{} near {} m {} ({} of the error)", place.node, text_of_vector(place.position), what,
                     text_of_percent(place.share));
}

std::string text_of_list(const std::vector<int>& numbers) {
  if (numbers.size() < 2) return fmt::format("{}", fmt::join(numbers, ""));
  return fmt::format("{} and {}", fmt::join(numbers.begin(), numbers.end() - 1, ", "), numbers.back());
}

std::string solve_text(const inverse::SolveResult& result) {
  std::vector<TextRow> rows{{"error, traced afresh", text_of_percent(result.relative_l2)},
                            {"error by the cache", text_of_percent(result.relative_l2_cached)},
                            {"before the last optimisation", text_of_percent(result.initial_relative_l2)}};
  rows.emplace_back("its noise, taken out", text_of_percent(result.verification_noise));
  if (result.target_noise > 0) rows.emplace_back("noise of the target", text_of_percent(result.target_noise));
  if (!result.error_curve.empty())
    rows.emplace_back("in the search, by number of lights", text_of_curve(result.error_curve));
  for (const std::vector<int>& group : inverse::groups_not_told_apart(result)) {
    rows.emplace_back("not told apart", fmt::format("lights {}: only their sum is known", text_of_list(group)));
  }
  if (!result.not_reached.empty()) rows.emplace_back("not reached", text_of_places(result.not_reached));
  if (!result.advice.empty()) rows.emplace_back("advice", result.advice);
  rows.emplace_back("ended", inverse::words_for(result.termination));
  for (const inverse::StageReport& stage : result.stages) rows.emplace_back(stage.name, text_of_seconds(stage.seconds));
  rows.emplace_back("total", text_of_seconds(result.total_seconds));
  return light_table(result.lights) + "\n" + aligned_rows(rows);
}

}  // namespace chiaro::cli
