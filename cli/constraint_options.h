#pragma once
// What lights may be: options, and a file of them.

#include <string>

#include "cli/transport_options.h"
#include "inverse/solve/light_constraints.h"
#include "inverse/solve/solve.h"

namespace CLI {
class App;
}  // namespace CLI

namespace chiaro::cli {

struct ConstraintOptions {
  inverse::LightConstraints given;  // as options, but for regions, which bakes have, too
  std::string file;
  const CLI::App* command = nullptr;  // that they are options of
};

// --constraints and all that its file may hold, but for --region.
void add_constraint_options(CLI::App& command, ConstraintOptions& options);

// Options before the file's. UsageError where two of them exclude each other.
inverse::LightConstraints choose_constraints(const ConstraintOptions& options, const GridOptions& grid);

// UsageError where the method does not know them.
void require_known_to(inverse::SolveMethod method, const inverse::LightConstraints& constraints,
                      const ConstraintOptions& options);

inverse::PlaceRules place_rules(const renderer::Scene& scene, const inverse::LightConstraints& constraints);
// Before the work: Error, as a solve would end with it, where no light of the grid is near a place that the rules
// allow.
void require_a_place(const renderer::Scene& scene, const inverse::LightGrid& grid, const inverse::PlaceRules& rules,
                     const renderer::Control& control);

inverse::IntensityRules intensity_rules(const inverse::LightConstraints& constraints);

}  // namespace chiaro::cli
