#include "inverse/solve/report.h"

#include "inverse/solve/report_data.h"
#include "inverse/solve/report_page.h"
#include "renderer/core/atomic_file.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"

namespace chiaro::inverse {
namespace {

// A picture on the target's receivers, with its weights: any glTF program shows its colours.
void save_values(const Target& target, std::vector<Vec3f> values, const std::filesystem::path& path) {
  save_target({target.receivers, std::move(values), target.weight, {}}, path);
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
    const Vec3f times_8 = 8 * abs(illumination[i] - target.illumination[i]);
    difference.push_back(min(times_8, Vec3f{renderer::kBrightest, renderer::kBrightest, renderer::kBrightest}));
  }
  return difference;
}

}  // namespace

const std::vector<std::string>& report_files() {
  static const std::vector<std::string> kFiles{"importance.glb",    "target.glb",  "found.glb",
                                               "difference_x8.glb", "stages.json", "report.html"};
  return kFiles;
}

void write_report(const renderer::Scene& scene, const Target& target, const SolveResult& result,
                  const std::filesystem::path& folder) {
  CHIARO_CHECK(result.found_by_stages != nullptr);
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed || !std::filesystem::is_directory(folder)) {
    throw renderer::Error({folder.string(), "", "cannot be made", "a folder for the report"});
  }
  const SolveTrace trace{scene, target, *result.found_by_stages, result};
  save_values(target, importance_colors(trace.stages.importance), folder / "importance.glb");
  save_target(target, folder / "target.glb");
  save_values(target, result.illumination, folder / "found.glb");
  save_values(target, difference_times_8(target, result.illumination), folder / "difference_x8.glb");
  renderer::write_file_atomically(folder / "stages.json", stages_json(trace));
  renderer::write_file_atomically(folder / "report.html", make_report_page(page_json(trace)));
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
