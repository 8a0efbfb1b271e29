#include "cli/bake_summary.h"

#include <fmt/format.h>

namespace chiaro::cli {

JsonObject grid_summary(const inverse::LightGrid& grid, std::size_t lights) {
  return {{"counts", JsonList{grid.counts[0], grid.counts[1], grid.counts[2]}},
          {"origin", grid.origin},
          {"spacing", grid.spacing},
          {"finer_lights", grid.finer.size()},
          {"lights", lights}};
}

std::string text_of_lights(const inverse::LightGrid& grid) {
  const std::string text = fmt::format("{} on a grid of {} x {} x {}", grid.positions.size(), grid.counts[0],
                                       grid.counts[1], grid.counts[2]);
  return grid.finer.empty() ? text : fmt::format("{}, {} of them in finer cells", text, grid.finer.size());
}

JsonObject bake_summary(const inverse::TransportCache& header, const inverse::BakeSummary& summary) {
  return {{"receivers", header.receiver_count},
          {"lights", header.grid.positions.size()},
          {"grid", grid_summary(header.grid, header.grid.positions.size())},
          {"samples", header.settings.samples},
          {"bounces", header.settings.bounces},
          {"materials", header.settings.materials},
          {"scene_fingerprint", header.scene_fingerprint},
          {"receiver_fingerprint", header.receiver_fingerprint},
          {"indirect_relative_error", header.indirect_relative_error},
          {"shadow_rays", summary.shadow_rays},
          {"gather_rays", summary.gather_rays},
          {"gather_points", summary.gather_points},
          {"records", summary.records},
          {"stages", JsonList{JsonObject{{"name", "direct"}, {"seconds", summary.direct_seconds}},
                              JsonObject{{"name", "indirect"}, {"seconds", summary.indirect_seconds}},
                              JsonObject{{"name", "check"}, {"seconds", summary.check_seconds}},
                              JsonObject{{"name", "write"}, {"seconds", summary.write_seconds}}}}};
}

}  // namespace chiaro::cli
