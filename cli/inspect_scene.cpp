#include <fmt/format.h>

#include "cli/inspect.h"
#include "cli/scene_loading.h"
#include "renderer/io/load_gltf.h"

namespace chiaro::cli {
namespace {

using renderer::Scene;
using renderer::Vec3f;

void add_count(Inspection& inspection, const std::string& name, std::size_t count) {
  inspection.add(name, count, name, fmt::format("{}", count));
}

void add_geometry(Inspection& inspection, const Scene& scene) {
  std::size_t triangles = 0, vertices = 0;
  for (const renderer::Mesh& mesh : scene.meshes) {
    triangles += mesh.triangles.size();
    vertices += mesh.positions.size();
  }
  const std::size_t drawn = renderer::drawn_triangle_count(scene);
  inspection.add("triangles", drawn, "triangles", fmt::format("{} drawn, {} unique", drawn, triangles));
  inspection.summary.emplace_back("unique_triangles", triangles);
  add_count(inspection, "vertices", vertices);
  add_count(inspection, "instances", scene.instances.size());
  add_count(inspection, "meshes", scene.meshes.size());
}

void add_bounds(Inspection& inspection, const renderer::Box3f& box) {
  if (box.empty()) return;
  inspection.add("bounds", JsonObject{{"min", box.min}, {"max", box.max}}, "bounds",
                 fmt::format("{} to {} m", text_of_vector(box.min), text_of_vector(box.max)));
  inspection.rows.emplace_back("size", text_of_vector(box.extent()) + " m");
}

void add_materials(Inspection& inspection, const Scene& scene) {
  add_count(inspection, "materials", scene.materials.size());
  std::size_t emissive = 0;
  for (const renderer::Material& material : scene.materials) emissive += renderer::max_component(material.emission) > 0;
  inspection.add("emissive_materials", emissive, "emissive", fmt::format("{} materials", emissive));
  add_count(inspection, "textures", scene.textures.size());
}

std::string text_of_camera(const renderer::Camera& camera) {
  const std::string lens = camera.orthographic ? fmt::format("orthographic, {:.4g} m high", 2 * camera.half_height)
                                               : fmt::format("{:.4g}° high", degrees_of(camera.vertical_fov));
  return fmt::format("{}: at {} m, {}", camera.name, text_of_vector(camera.world_from_camera.column(3)), lens);
}

void add_cameras(Inspection& inspection, const Scene& scene) {
  JsonList cameras;
  for (const renderer::Camera& camera : scene.cameras) {
    cameras.emplace_back(JsonObject{{"name", camera.name},
                                    {"position", camera.world_from_camera.column(3)},
                                    {"orthographic", camera.orthographic},
                                    {"aspect_ratio", camera.aspect_ratio}});
    inspection.rows.emplace_back("camera", text_of_camera(camera));
  }
  inspection.summary.emplace_back("cameras", cameras);
}

struct LightJson {
  JsonObject operator()(const renderer::PointLight& l) const {
    return {{"type", "point"}, {"name", l.name}, {"position", l.position}, {"intensity", l.intensity}};
  }
  JsonObject operator()(const renderer::SpotLight& l) const {
    return {{"type", "spot"},
            {"name", l.name},
            {"position", l.position},
            {"intensity", l.intensity},
            {"direction", l.direction},
            {"inner_cone_angle", l.inner_cone_angle},
            {"outer_cone_angle", l.outer_cone_angle}};
  }
  JsonObject operator()(const renderer::DirectionalLight& l) const {
    return {{"type", "directional"}, {"name", l.name}, {"direction", l.direction}, {"intensity", l.illuminance}};
  }
  JsonObject operator()(const renderer::EnvironmentLight& l) const {
    return {{"type", "environment"},   {"name", l.name},         {"image", l.image},        {"width", l.map->width},
            {"height", l.map->height}, {"rotation", l.rotation}, {"intensity", l.intensity}};
  }
};

struct LightRow {
  std::string operator()(const renderer::PointLight& l) const {
    return fmt::format("point at {} m, {} cd", text_of_vector(l.position), text_of_vector(l.intensity));
  }
  std::string operator()(const renderer::SpotLight& l) const {
    return fmt::format("spot at {} m towards {}, {} cd, {:.3g}° to {:.3g}°", text_of_vector(l.position),
                       text_of_vector(l.direction), text_of_vector(l.intensity), degrees_of(l.inner_cone_angle),
                       degrees_of(l.outer_cone_angle));
  }
  std::string operator()(const renderer::DirectionalLight& l) const {
    return fmt::format("directional towards {}, {} lux", text_of_vector(l.direction), text_of_vector(l.illuminance));
  }
  std::string operator()(const renderer::EnvironmentLight& l) const {
    return fmt::format("environment of {} x {} pixels, times {:.4g} cd/m², turned by {:.4g}°", l.map->width,
                       l.map->height, l.intensity, degrees_of(l.rotation));
  }
};

}  // namespace

void add_lights(Inspection& inspection, const renderer::Lights& lights) {
  JsonList list;
  inspection.rows.emplace_back("lights", fmt::format("{}", lights.size()));
  for (const renderer::Light& light : lights) {
    list.emplace_back(std::visit(LightJson{}, light));
    const std::string name = renderer::name_of(light).empty() ? "" : renderer::name_of(light) + ": ";
    inspection.rows.emplace_back("light", name + std::visit(LightRow{}, light));
  }
  inspection.summary.emplace_back("lights", list);
}

Inspection inspect_scene(const std::string& file, const renderer::LoadOptions& load, const renderer::Control& control) {
  const renderer::LoadedScene loaded = renderer::load_gltf(file, load, control);
  Inspection inspection = start_inspection("scene", file);
  inspection.warnings = loaded.warnings;
  add_geometry(inspection, loaded.scene);
  add_bounds(inspection, renderer::bounds(loaded.scene));
  add_materials(inspection, loaded.scene);
  add_variants(inspection, loaded.variants);
  add_cameras(inspection, loaded.scene);
  add_lights(inspection, loaded.lights);
  const std::string fingerprint = renderer::fingerprint(loaded.scene);
  inspection.add("fingerprint", fingerprint, "fingerprint", fingerprint);
  if (loaded.scene.cameras.empty()) inspection.warnings.push_back(file + ": has no camera");
  if (loaded.lights.empty() && !renderer::has_emission(loaded.scene)) {
    inspection.warnings.push_back(file + ": has no lights, and nothing in it emits");
  }
  return inspection;
}

}  // namespace chiaro::cli
