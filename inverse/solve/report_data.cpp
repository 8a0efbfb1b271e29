#include "inverse/solve/report_data.h"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "inverse/solve/not_told_apart.h"
#include "inverse/solve/packed_values.h"

namespace chiaro::inverse {
namespace {

using nlohmann::json;

json vector_json(Vec3f v) { return {v.x, v.y, v.z}; }

json light_json(const renderer::PointLight& light) {
  return {{"type", "point"}, {"position", vector_json(light.position)}, {"intensity", vector_json(light.intensity)}};
}

json lights_json(const LightEstimates& lights) {
  json list = json::array();
  for (const LightEstimate& l : lights) {
    list.push_back({{"type", "point"},
                    {"position", {l.position.x(), l.position.y(), l.position.z()}},
                    {"intensity", {l.intensity[0], l.intensity[1], l.intensity[2]}}});
  }
  return list;
}

json tree_json(const SolveTrace& trace) {
  json nodes = json::array();
  for (const auto& node : trace.stages.tree.tree.nodes) {
    nodes.push_back({{"left", node.left}, {"right", node.right}, {"distance", node.distance}});
  }
  return {{"leaves", trace.stages.tree.tree.leaf_count},
          {"nodes", nodes},
          {"representatives", lights_json(trace.stages.tree.representatives)},
          {"cut", trace.stages.cut}};
}

json curve_json(const std::vector<LightSet>& curve) {
  json list = json::array();
  for (const LightSet& set : curve) {
    json lights = json::array();
    for (const renderer::PointLight& light : set.lights) lights.push_back(light_json(light));
    list.push_back({{"light_count", set.lights.size()}, {"relative_l2", set.relative_l2}, {"lights", lights}});
  }
  return list;
}

json stage_json(const StageReport& stage) {
  json figures = json::object();
  for (const auto& [name, value] : stage.figures) figures[name] = value;
  return {{"name", stage.name}, {"figures", figures}};
}

json stages_of(const SolveTrace& trace) {
  json figures = json::array();
  for (const StageReport& stage : trace.result.stages) figures.push_back(stage_json(stage));
  return {{"coarse", lights_json(trace.stages.distribution.rounds[0].lights)},
          {"fine", lights_json(trace.stages.distribution.rounds[1].lights)},
          {"clusters", lights_json(trace.stages.clusters)},
          {"tree", tree_json(trace)},
          {"found", lights_json(trace.stages.found)},
          {"error_curve", curve_json(trace.result.error_curve)},
          {"stages", figures}};
}

json found_json(const FoundLight& found) {
  const auto& point = std::get<renderer::PointLight>(found.light);  // sought lights are
  json light = light_json(point);
  light["name"] = point.name;
  light["contribution"] = found.contribution;
  light["interval_90"] = {{"position", vector_json(found.position_interval)},
                          {"intensity", vector_json(found.intensity_interval)}};
  return light;
}

json place_json(const NotReached& place) {
  return {{"node", place.node},
          {"position", vector_json(place.position)},
          {"share_of_error", place.share},
          {"too_dark", place.excess < 0},
          {"relative_excess", place.wanted > 0 ? json(place.excess / place.wanted) : json()},
          {"other_color", place.other_color}};
}

json result_json(const SolveResult& result) {
  json places = json::array();
  for (const NotReached& place : result.not_reached) places.push_back(place_json(place));
  json lights = json::array(), seconds = json::array();
  for (const FoundLight& found : result.lights) lights.push_back(found_json(found));
  for (const StageReport& stage : result.stages) seconds.push_back(stage.seconds);
  return {{"lights", lights},
          {"relative_l2", result.relative_l2},
          {"relative_l2_cached", result.relative_l2_cached},
          {"initial_relative_l2", result.initial_relative_l2},
          {"verification_noise", result.verification_noise ? json(*result.verification_noise) : json()},
          {"target_noise", result.target_noise},
          {"important_vertices", result.important_vertices},
          {"stage_seconds", seconds},
          {"not_told_apart", groups_not_told_apart(result)},
          {"not_reached", places},
          {"advice", result.advice},
          {"termination", words_for(result.termination)}};
}

std::vector<Vec3f> difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  std::vector<Vec3f> result(a.size());
  std::transform(a.begin(), a.end(), b.begin(), result.begin(), [](Vec3f x, Vec3f y) { return x - y; });
  return result;
}

// For half floats, which are most exact where the largest value is near their own largest.
float half_scale(const std::vector<Vec3f>& values) {
  constexpr float kNearLargestHalf = 60000;
  float largest = 0;
  for (const Vec3f& v : values) largest = std::max(largest, max_component(abs(v)));
  return largest > 0 ? largest / kNearLargestHalf : 1;
}

json halves_json(const std::vector<Vec3f>& values) {
  const float scale = half_scale(values);
  return {{"values", pack_halves(values, scale)}, {"scale", scale}};
}

template <class Real>
json bytes_json(const std::vector<Real>& values) {
  const Real scale = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  return {{"values", pack_bytes(values, double(scale))}, {"scale", scale}};
}

json receivers_json(const SolveTrace& trace) {
  const Receivers& receivers = trace.target.receivers;
  renderer::Box3f box;
  for (const Vec3f& p : receivers.positions) box.extend(p);
  return {{"count", receivers.size()},
          {"triangle_count", receivers.triangles.size()},
          {"min", vector_json(box.min)},
          {"max", vector_json(box.max)},
          {"positions", pack_within(receivers.positions, box)},
          {"triangles", pack_triangles(receivers.triangles)},
          {"target", halves_json(trace.target.illumination)},
          {"difference", halves_json(difference(trace.result.illumination, trace.target.illumination))},
          {"weight", bytes_json(trace.target.weight)},
          {"importance", bytes_json(trace.stages.importance.total)},
          {"geometry", bytes_json(trace.stages.importance.geometry)},
          {"laplacian", bytes_json(trace.stages.importance.illumination)},
          {"chosen", pack_indices(trace.stages.importance.chosen)}};
}

json cameras_json(const std::vector<renderer::Camera>& cameras) {
  json list = json::array();
  for (const renderer::Camera& camera : cameras) {
    list.push_back({{"name", camera.name},
                    {"position", vector_json(camera.world_from_camera.column(3))},
                    {"backward", vector_json(camera.world_from_camera.column(2))},
                    {"vertical_fov", camera.orthographic ? 0.7F : camera.vertical_fov}});
  }
  return list;
}

std::string without_less_than(const std::string& json_text) {
  std::string escaped;
  escaped.reserve(json_text.size());
  for (const char c : json_text) c == '<' ? escaped.append("\\u003c") : escaped.append(1, c);
  return escaped;
}

}  // namespace

std::string stages_json(const SolveTrace& trace) { return stages_of(trace).dump(1) + "\n"; }

std::string page_json(const SolveTrace& trace) {
  json data = stages_of(trace);
  data["scene"] = std::filesystem::path(trace.scene.path).filename().string();
  data["cameras"] = cameras_json(trace.scene.cameras);
  data["receivers"] = receivers_json(trace);
  data["grid"] = pack_floats(trace.stages.grid.positions);
  data["result"] = result_json(trace.result);
  return without_less_than(data.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace chiaro::inverse
