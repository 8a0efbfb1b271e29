#include "inverse/solve/report.h"

#include <nlohmann/json.hpp>

#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"

namespace chiaro::inverse {
namespace {

using nlohmann::json;

json lights_json(const LightEstimates& lights) {
  json list = json::array();
  for (const LightEstimate& l : lights) {
    list.push_back({{"type", "point"},
                    {"position", {l.position.x(), l.position.y(), l.position.z()}},
                    {"intensity", {l.intensity[0], l.intensity[1], l.intensity[2]}}});
  }
  return list;
}

json tree_json(const LightTree& tree) {
  json nodes = json::array();
  for (const auto& node : tree.tree.nodes) {
    nodes.push_back({{"left", node.left}, {"right", node.right}, {"distance", node.distance}});
  }
  return {{"leaves", tree.tree.leaf_count}, {"nodes", nodes}, {"representatives", lights_json(tree.representatives)}};
}

// A picture on the receivers: any glTF program shows its colours.
void save_values(const Receivers& receivers, const std::vector<Vec3f>& values, const std::filesystem::path& path) {
  save_target({receivers, values, std::vector<float>(values.size(), 1.0F), {}}, path);
}

std::vector<Vec3f> importance_colors(const Importance& importance) {
  std::vector<Vec3f> colors;
  for (std::size_t i = 0; i < importance.total.size(); ++i) {
    colors.push_back({float(importance.geometry[i]), float(importance.illumination[i]), 0});
  }
  for (const std::size_t i : importance.chosen) colors[i].z = 1;
  return colors;
}

std::vector<Vec3f> difference_times_8(const Target& target, const std::vector<Vec3f>& illumination) {
  std::vector<Vec3f> difference;
  for (std::size_t i = 0; i < illumination.size(); ++i) {
    difference.push_back(8 * abs(illumination[i] - target.illumination[i]));
  }
  return difference;
}

}  // namespace

void write_report(const SolveTrace& trace, const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed || !std::filesystem::is_directory(folder)) {
    throw renderer::Error({folder.string(), "", "cannot be made", "a folder for the report"});
  }
  const Receivers& receivers = trace.target.receivers;
  save_values(receivers, importance_colors(trace.importance), folder / "importance.glb");
  save_values(receivers, trace.target.illumination, folder / "target.glb");
  save_values(receivers, trace.illumination, folder / "found.glb");
  save_values(receivers, difference_times_8(trace.target, trace.illumination), folder / "difference_x8.glb");
  const json stages{{"coarse", lights_json(trace.distribution.rounds[0].lights)},
                    {"fine", lights_json(trace.distribution.rounds[1].lights)},
                    {"clusters", lights_json(trace.clusters)},
                    {"tree", tree_json(trace.tree)},
                    {"found", lights_json(trace.found)}};
  renderer::write_file_atomically(folder / "stages.json", stages.dump(1) + "\n");
}

std::vector<std::pair<std::string, double>> distribution_figures(const LightDistribution& distribution) {
  std::vector<std::pair<std::string, double>> figures;
  const char* const names[2] = {"coarse_", "fine_"};
  for (int r = 0; r < 2; ++r) {
    const DistributionRound& round = distribution.rounds[r];
    const std::string name = names[r];
    figures.insert(figures.end(), {{name + "spread", double(round.spread)},
                                   {name + "lit", double(round.lit)},
                                   {name + "kept", double(round.kept)},
                                   {name + "kkt_residual", round.kkt_residual},
                                   {name + "relative_l2", round.relative_error}});
  }
  return figures;
}

}  // namespace chiaro::inverse
