#pragma once
// What each stage of a solve found, to look at: the thesis' figures 3.2 to 3.8, 4.1 and 4.2 for this run.

#include <filesystem>

#include "inverse/solve/important_vertices.h"
#include "inverse/solve/light_clusters.h"

namespace chiaro::inverse {

struct SolveTrace {
  const Target& target;
  const Importance& importance;
  const LightDistribution& distribution;
  const LightEstimates& clusters;
  const LightTree& tree;
  const LightEstimates& found;
  const std::vector<Vec3f>& illumination;  // of the found lights, per receiver
};

// Into `folder`, made if it is missing: importance.glb (R geometry, G illumination, B chosen), target.glb, found.glb,
// difference_x8.glb, and stages.json with the lights of every stage. Error where the folder cannot be made.
void write_report(const SolveTrace& trace, const std::filesystem::path& folder);

// Of both rounds, for the stage's figures.
std::vector<std::pair<std::string, double>> distribution_figures(const LightDistribution& distribution);

}  // namespace chiaro::inverse
