#include "renderer/io/gltf_lights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/counted.h"
#include "renderer/core/world_limits.h"

namespace chiaro::renderer {
namespace {

std::string light_place(int light) { return fmt::format("extensions.KHR_lights_punctual.lights[{}]", light); }

std::string name_of(const PlacedNode& node, const tinygltf::Light& light) {
  if (!node.name.empty()) return node.name;
  return light.name.empty() ? fmt::format("light {}", node.light) : light.name;
}

Vec3f intensity_of(const GltfDocument& document, int index) {
  const tinygltf::Light& light = document.model->lights[index];
  const std::vector<double> color = light.color.empty() ? std::vector<double>{1, 1, 1} : light.color;
  const Vec3f intensity{float(color[0] * light.intensity), float(color[1] * light.intensity),
                        float(color[2] * light.intensity)};
  if (!is_finite(intensity)) fail(document, light_place(index), "its intensity is not finite", "finite numbers");
  if (max_component(intensity) > kBrightest) {
    fail(document, light_place(index), "its intensity is too bright", fmt::format("at most {:g}", kBrightest));
  }
  return intensity;
}

// Lights shine along their node's -Z axis. Absent where the node's scale leaves none.
std::optional<Vec3f> direction_of(const PlacedNode& node) {
  const Vec3f axis = transform_direction(node.world_from_node, {0, 0, -1});
  const double l = std::hypot(double(axis.x), double(axis.y), double(axis.z));
  if (!(l > 0)) return std::nullopt;
  return Vec3f{float(axis.x / l), float(axis.y / l), float(axis.z / l)};
}

SpotLight make_spot(const GltfDocument& document, const PlacedNode& node, Vec3f direction) {
  const tinygltf::Light& light = document.model->lights[node.light];
  const float inner = float(light.spot.innerConeAngle), outer = float(light.spot.outerConeAngle);
  if (inner > outer || outer <= 0) {
    fail(document, light_place(node.light) + ".spot", fmt::format("inner angle {}, outer angle {}", inner, outer),
         "an outer angle above 0, and an inner one not above it");
  }
  return {name_of(node, light),
          node.world_from_node.column(3),
          direction,
          intensity_of(document, node.light),
          inner,
          outer};
}

// Absent for a light that has no direction to shine in.
std::optional<Light> read_light(const GltfDocument& document, const PlacedNode& node) {
  const tinygltf::Light& light = document.model->lights[node.light];
  const Vec3f position = node.world_from_node.column(3), intensity = intensity_of(document, node.light);
  if (light.type == "point") return PointLight{name_of(node, light), position, intensity};
  if (light.type != "spot" && light.type != "directional") {
    fail(document, light_place(node.light) + ".type", fmt::format("is \"{}\"", light.type.substr(0, 40)),
         "point, spot or directional");
  }
  const std::optional<Vec3f> direction = direction_of(node);
  if (!direction) return std::nullopt;
  if (light.type == "spot") return make_spot(document, node, *direction);
  return DirectionalLight{name_of(node, light), *direction, intensity};
}

// The rotation of a transform, axes at right angles whatever its scale or mirroring.
Mat4f without_scale(const Mat4f& transform) {
  const auto unit = [](Vec3f v, Vec3f otherwise) {
    const float l = length(v);
    return l > 0 && std::isfinite(l) ? v / l : otherwise;
  };
  const Vec3f z = unit(transform.column(2), {0, 0, 1});
  const Vec3f x = unit(cross(unit(transform.column(1), {0, 1, 0}), z), Frame3f(z).tangent);
  const Vec3f y = cross(z, x), position = transform.column(3);
  return {{x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, position.x, position.y, position.z, 1}};
}

void set_perspective(Camera& camera, const tinygltf::PerspectiveCamera& source) {
  camera.vertical_fov = float(source.yfov);
  camera.aspect_ratio = float(source.aspectRatio);
  camera.near = float(source.znear);
  camera.far = source.zfar > 0 ? float(source.zfar) : kInfinity;
}

void set_orthographic(Camera& camera, const tinygltf::OrthographicCamera& source) {
  camera.orthographic = true;
  camera.half_width = float(std::abs(source.xmag));
  camera.half_height = float(std::abs(source.ymag));
  camera.near = float(source.znear);
  camera.far = float(source.zfar);
  if (camera.half_height > 0) camera.aspect_ratio = camera.half_width / camera.half_height;
}

Camera read_camera(const GltfDocument& document, const PlacedNode& node) {
  const tinygltf::Camera& source = document.model->cameras[node.camera];
  Camera camera;
  camera.name = !node.name.empty()     ? node.name
                : !source.name.empty() ? source.name
                                       : fmt::format("camera {}", node.camera);
  camera.world_from_camera = without_scale(node.world_from_node);
  if (source.type == "orthographic") {
    set_orthographic(camera, source.orthographic);
  } else {
    set_perspective(camera, source.perspective);
  }
  // m: of less, and of planes beyond, matrices of a frame's header would not be numbers
  constexpr float kLeast = 1e-6F, kFarthest = 4 * float(kWorldLimit);
  if (camera.far > kFarthest && !camera.orthographic) camera.far = kInfinity;
  const bool has_size = !camera.orthographic || std::min(camera.half_width, camera.half_height) >= kLeast;
  if (!has_size || camera.far <= camera.near || camera.near > kFarthest) {
    fail(document, fmt::format("cameras[{}]", node.camera), "sees nothing",
         "a size, znear within the world and zfar beyond it");
  }
  return camera;
}

}  // namespace

NodeLights read_lights(const GltfDocument& document, const std::vector<PlacedNode>& nodes,
                       std::vector<std::string>& warnings) {
  NodeLights read;
  std::size_t with_range = 0;
  for (const PlacedNode& node : nodes) {
    if (node.light < 0) continue;
    check_in_world(document, node, node.world_from_node.column(3), "a light");
    with_range += document.model->lights[node.light].range > 0 ? 1 : 0;
    if (const std::optional<Light> light = read_light(document, node)) {
      read.lights.push_back(*light);
      read.nodes.push_back(node.node);
    } else {
      warnings.push_back(fmt::format("{}: a light scaled to nothing is left out", place_of(node)));
    }
  }
  if (with_range > 0)
    warnings.push_back(fmt::format("the range of {} is ignored", counted(with_range, "light", "lights")));
  return read;
}

std::vector<Camera> read_cameras(const GltfDocument& document, const std::vector<PlacedNode>& nodes) {
  std::vector<Camera> cameras;
  for (const PlacedNode& node : nodes) {
    if (node.camera < 0) continue;
    check_in_world(document, node, node.world_from_node.column(3), "a camera");
    cameras.push_back(read_camera(document, node));
  }
  return cameras;
}

}  // namespace chiaro::renderer
