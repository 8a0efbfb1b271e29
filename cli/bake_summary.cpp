#include "cli/bake_summary.h"

namespace chiaro::cli {

JsonObject grid_summary(const inverse::LightGrid& grid, std::size_t lights) {
  return {{"counts", JsonList{grid.counts[0], grid.counts[1], grid.counts[2]}},
          {"origin", grid.origin},
          {"spacing", grid.spacing},
          {"lights", lights}};
}

JsonObject bake_summary(const inverse::TransportCache& header, const inverse::BakeSummary& summary) {
  return {{"receivers", header.receiver_count},
          {"lights", header.grid.positions.size()},
          {"grid", grid_summary(header.grid, header.grid.positions.size())},
          {"samples", header.settings.samples},
          {"bounces", header.settings.bounces},
          {"materials", header.settings.materials},
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
