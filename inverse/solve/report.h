#pragma once
// What each stage of a solve found, to look at: the thesis' figures 3.2 to 3.8, 4.1 and 4.2 for this run.

#include <filesystem>

#include "inverse/solve/important_vertices.h"
#include "inverse/solve/light_clusters.h"
#include "inverse/solve/solve.h"

namespace chiaro::inverse {

struct SolveStages {
  Importance importance;
  LightGrid grid;
  LightDistribution distribution;
  LightEstimates clusters;
  LightTree tree;
  std::vector<int> cut;  // nodes of the tree
  LightEstimates found;
};

struct SolveTrace {
  const renderer::Scene& scene;
  const Target& target;
  const SolveStages& stages;
  const SolveResult& result;
};

// Into `folder`, made if it is missing: report.html, a page to look at in a browser; importance.glb (R geometry,
// G illumination, B chosen), target.glb, found.glb, difference_x8.glb; and stages.json with the lights and the figures
// of every stage. Of a result whose stages were kept. Error where the folder cannot be made.
void write_report(const renderer::Scene& scene, const Target& target, const SolveResult& result,
                  const std::filesystem::path& folder);

// The names of these files.
const std::vector<std::string>& report_files();

// Of both rounds, for the stage's figures.
std::vector<std::pair<std::string, double>> distribution_figures(const LightDistribution& distribution);

}  // namespace chiaro::inverse
