#pragma once

#include <functional>

#include "inverse/transport/gather_operator.h"
#include "inverse/transport/irradiance_records.h"
#include "inverse/transport/receivers.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/core/control.h"

namespace chiaro::inverse {

struct BakeSummary {
  double direct_seconds = 0, indirect_seconds = 0, check_seconds = 0, write_seconds = 0;
  std::size_t shadow_rays = 0, gather_rays = 0, gather_points = 0, records = 0;
};

// Transport from every light of the grid to every receiver: direct visibility, and indirect light through shared gather
// points (gather_operator.h), which records gather and the other receivers interpolate (irradiance_records.h). Entries
// do not depend on the parts that they are computed in, nor on what was before.
class Baker {
 public:
  // Traces the gather points. Keeps references to tracer and receivers, which must outlive it. `memory`: bytes that it
  // may work with beyond them; Error where they are too few.
  Baker(const renderer::RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
        const BakeSettings& settings, double memory, const renderer::Control& control = {});

  // What a cache has but for its entries.
  const TransportCache& header() const { return header_; }
  const BakeSummary& summary() const { return summary_; }

  // From where a bake begins or goes on, in the order of TransportCacheWriter.
  struct Place {
    std::size_t light = 0, receiver = 0;
  };
  // Receivers [first, last), in blocks, from `start` on. Progress is that of the whole.
  void bake(std::size_t first, std::size_t last, Place start, const std::function<void(const TransportBlock&)>& visit,
            const renderer::Control& control);

 private:
  double bytes_kept() const;
  void require_memory(double bytes, double least) const;
  void set_memory(double bytes);
  void set_receivers(std::size_t first, std::size_t last);
  void set_lights(std::size_t first, std::size_t count, const renderer::Control& control);
  void gather_at_records(std::size_t first, std::size_t count, std::vector<LightBlock>* illumination,
                         const renderer::Control& control);
  SparseTransport trace_rows(std::span<const std::size_t> receivers, const renderer::Control& control) const;
  void fill_direct(TransportBlock& block, const renderer::Control& control);
  void fill_indirect(TransportBlock& block, const renderer::Control& control);
  double measure_indirect_error(const renderer::Control& control);

  const renderer::RayTracer& tracer_;
  const Receivers& receivers_;
  TransportCache header_;
  BakeSummary summary_;
  GatherOptions options_;
  GatherOperator gather_;
  IrradianceRecords records_;
  std::size_t receivers_at_once_ = 0, records_at_once_ = 0, lights_at_once_ = 0;
  bool keeps_rows_ = false;
  // Of the receivers set last: their records, and the rows of K_rg of so many of these at once as memory allows.
  std::size_t first_receiver_ = 0, last_receiver_ = 0;
  IrradianceRecords needed_;
  std::vector<SparseTransport> rows_;
  // Illumination of these records by the lights set last, block by block of lights.
  std::vector<std::vector<LightBlock>> illumination_;
};

struct BakeResult {
  TransportCache cache;
  BakeSummary summary;
};

// All of it in memory.
BakeResult bake(const renderer::RayTracer& tracer, const Receivers& receivers, const LightGrid& grid,
                const BakeSettings& settings, const renderer::Control& control = {});

}  // namespace chiaro::inverse
