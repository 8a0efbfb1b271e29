#include "cli/transport_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/add_options.h"
#include "cli/scene_options.h"
#include "inverse/transport/allowed_places.h"
#include "inverse/transport/receiver_samples.h"
#include "renderer/core/error.h"

namespace chiaro::cli {
namespace {

constexpr int kMaxSamples = 1 << 24;
constexpr int kMaxBounces = 10000;
constexpr double kLeastFractionOnSurface = 0.5, kNearlyAllOnSurface = 0.99;

}  // namespace

void add_transport_options(CLI::App& command, TransportOptions& options, const std::string& samples_help) {
  add_count(command, {"--samples", "N", fmt::format("{} (default {})", samples_help, options.samples)}, options.samples,
            {1, kMaxSamples});
  add_count(command, {"--bounces", "B", "Indirect bounces, 0 = direct only (default: until they no longer matter)"},
            options.bounces, {0, kMaxBounces});
  add_environment_options(command, options.environment);
  add_material_options(command, options.materials);
  add_scene_options(command, options.load);
}

renderer::TraceOptions trace_options(const TransportOptions& transport, const CommonOptions& common) {
  return {.samples = transport.samples, .bounces = transport.bounces.value_or(-1), .seed = common.seed};
}

inverse::BakeSettings bake_settings(const TransportOptions& transport, const CommonOptions& common) {
  return {.samples = transport.samples,
          .bounces = transport.bounces.value_or(-1),
          .seed = common.seed,
          .materials = text_of_materials(transport.materials)};
}

void add_grid_options(CLI::App& command, GridOptions& options) {
  add_parsed(command,
             {"--grid", "X,Y,Z|E%",
              "Lights along x, y and z, or as many as make a light between them right to E percent (default: about 700 "
              "together)"},
             [&options](const std::string& text) { options.size = parse_grid(text); });
  add_repeated(command,
               {"--region", "NODE|x0,y0,z0,x1,y1,z1",
                "Where lights may stand: the bounds of a node, or a box in metres; again for a further one (default: "
                "the whole scene, and solves look beyond it if need be)"},
               [&options](const std::string& text) { options.regions.push_back({parse_region_text(text)}); });
}

std::vector<renderer::Box3f> boxes_of(const renderer::Scene& scene, const std::vector<inverse::Region>& regions) {
  std::vector<renderer::Box3f> boxes;
  for (const inverse::Region& region : regions) boxes.push_back(inverse::parse_region(scene, region));
  return boxes;
}

inverse::LightGridOptions light_grid_options(const renderer::Scene& scene, const GridOptions& options) {
  return inverse::around_places({.counts = options.size.counts, .error = options.size.error}, scene,
                                {.boxes = boxes_of(scene, options.regions)});
}

void add_max_edge_option(CLI::App& command, float& max_edge) {
  add_number(command, {"--max-edge", "M", "Split edges longer than M metres (default: from the scene's size)"},
             max_edge, kPositive);
}

void add_surface_options(CLI::App& command, SurfaceOptions& options) {
  add_input_file(command, {"--on", "R.glb", "The receivers of this file instead of ones made from the scene"},
                 options.on);
  add_max_edge_option(command, options.max_edge);
  command.get_option("--max-edge")->excludes("--on");
}

inverse::Receivers choose_receivers(const renderer::RayTracer& tracer, const SurfaceOptions& options,
                                    Session& session) {
  if (options.on.empty()) {
    inverse::Receivers receivers =
        inverse::make_receivers(tracer.scene(), {.max_edge = options.max_edge}, session.control());
    inverse::place_samples_on(tracer, receivers);
    return receivers;
  }
  const renderer::VertexMesh mesh = renderer::load_vertex_mesh(options.on);
  inverse::Receivers receivers = inverse::receivers_from_mesh(mesh);
  place_on_scene(tracer, receivers, options.on, session);
  session.warn(mesh.warnings);
  return receivers;
}

void place_on_scene(const renderer::RayTracer& tracer, inverse::Receivers& receivers, const std::string& file,
                    Session& session) {
  if (receivers.size() == 0) throw renderer::Error({file, "", "has no vertices", "receivers"});
  const double fraction = inverse::fraction_on_surface(tracer, receivers);
  if (fraction < kLeastFractionOnSurface) {
    throw renderer::Error({file, "receivers",
                           fmt::format("belong to another scene: {:.0f} % lie on the surfaces of {}", 100 * fraction,
                                       tracer.scene().path),
                           "points on the scene's surfaces"});
  }
  if (fraction < kNearlyAllOnSurface) {
    session.warn(fmt::format("{}: {:.0f} % of the vertices lie on no surface of {}: was the scene changed since?", file,
                             100 * (1 - fraction), tracer.scene().path));
  }
  inverse::place_samples_on(tracer, receivers);
}

}  // namespace chiaro::cli
