#pragma once

#include <optional>
#include <string>

#include "cli/common_options.h"
#include "cli/environment_options.h"
#include "cli/material_options.h"
#include "cli/option_values.h"
#include "cli/session.h"
#include "inverse/transport/light_grid.h"
#include "inverse/transport/receivers.h"
#include "inverse/transport/transport_cache.h"
#include "renderer/io/load_gltf.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::cli {

// What every command that transports light has.
struct TransportOptions {
  MaterialOptions materials;
  renderer::LoadOptions load;
  int samples = 256;
  std::optional<int> bounces;  // indirect ones; absent: until they no longer matter
  EnvironmentOptions environment = {};
};

// `samples_help` says what is sampled; the default is added to it.
void add_transport_options(CLI::App& command, TransportOptions& options, const std::string& samples_help);

renderer::TraceOptions trace_options(const TransportOptions& transport, const CommonOptions& common);
inverse::BakeSettings bake_settings(const TransportOptions& transport, const CommonOptions& common);

// --grid and --region.
struct GridOptions {
  GridSize size;
  std::vector<inverse::Region> regions;
};

void add_grid_options(CLI::App& command, GridOptions& options);
std::vector<renderer::Box3f> boxes_of(const renderer::Scene& scene, const std::vector<inverse::Region>& regions);
inverse::LightGridOptions light_grid_options(const renderer::Scene& scene, const GridOptions& options);

// --on and --max-edge.
struct SurfaceOptions {
  std::string on;
  float max_edge = 0;  // metres; 0: from the scene's size
};

void add_surface_options(CLI::App& command, SurfaceOptions& options);
void add_max_edge_option(CLI::App& command, float& max_edge);

// Those of the file given with --on, whose warnings are passed on, or made from the scene. Error where the file belongs
// to another scene.
inverse::Receivers choose_receivers(const renderer::RayTracer& tracer, const SurfaceOptions& options, Session& session);

// Places the samples of the receivers of `file` on the scene's surfaces. Warns where some lie on none, and throws an
// Error where fewer than half lie on any.
void place_on_scene(const renderer::RayTracer& tracer, inverse::Receivers& receivers, const std::string& file,
                    Session& session);

}  // namespace chiaro::cli
