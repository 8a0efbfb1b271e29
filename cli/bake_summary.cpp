#include "cli/bake_summary.h"

#include <unistd.h>

#include <fmt/format.h>

#include "cli/text_output.h"
#include "renderer/core/error.h"

namespace chiaro::cli {

double memory_bytes() { return double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE)); }

JsonObject grid_summary(const inverse::LightGrid& grid, std::size_t lights) {
  return {{"counts", JsonList{grid.counts[0], grid.counts[1], grid.counts[2]}},
          {"origin", grid.origin},
          {"spacing", grid.spacing},
          {"lights", lights}};
}

JsonObject bake_summary(const inverse::BakeResult& result) {
  const inverse::TransportCache& cache = result.cache;
  const inverse::BakeSummary& summary = result.summary;
  return {{"receivers", cache.receiver_count},
          {"lights", cache.grid.positions.size()},
          {"grid", grid_summary(cache.grid, cache.grid.positions.size())},
          {"samples", cache.settings.samples},
          {"bounces", cache.settings.bounces},
          {"materials", cache.settings.materials},
          {"indirect_relative_error", cache.indirect_relative_error},
          {"shadow_rays", summary.shadow_rays},
          {"gather_rays", summary.gather_rays},
          {"gather_points", summary.gather_points},
          {"stages", JsonList{JsonObject{{"name", "direct"}, {"seconds", summary.direct_seconds}},
                              JsonObject{{"name", "indirect"}, {"seconds", summary.indirect_seconds}},
                              JsonObject{{"name", "check"}, {"seconds", summary.check_seconds}}}}};
}

void require_memory_for_bake(const std::string& scene, const inverse::Receivers& receivers,
                             const inverse::LightGrid& grid) {
  constexpr double kBytesPerEntry = sizeof(std::uint8_t) + sizeof(renderer::Vec3f) + 4 * sizeof(float);
  const double needed = kBytesPerEntry * double(receivers.size()) * double(grid.positions.size());
  if (needed <= memory_bytes()) return;
  throw renderer::Error({scene, "bake",
                         fmt::format("{} receivers and {} lights need {}, this machine has {}", receivers.size(),
                                     grid.positions.size(), text_of_bytes(needed), text_of_bytes(memory_bytes())),
                         "a coarser --grid or a longer --max-edge"});
}

}  // namespace chiaro::cli
