#include "renderer/io/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/world_limits.h"
#include "renderer/io/gltf_accessors.h"

namespace chiaro::renderer {
namespace {

constexpr int kNoParent = -1;

std::string node_place(std::size_t node) { return fmt::format("nodes[{}]", node); }

std::vector<int> parents_of(const GltfDocument& document) {
  const auto& nodes = document.model->nodes;
  std::vector<int> parents(nodes.size(), kNoParent);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      if (parents[child] != kNoParent) {
        fail(document, node_place(child), fmt::format("is a child of nodes[{}] and of nodes[{}]", parents[child], i),
             "one parent");
      }
      parents[child] = int(i);
    }
  }
  return parents;
}

// Not finite where it has no direction.
Vec4f unit_quaternion(const std::vector<double>& q) {
  const double l = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {float(q[0] / l), float(q[1] / l), float(q[2] / l), float(q[3] / l)};
}

Vec3f vec3_or(const std::vector<double>& values, Vec3f otherwise) {
  return values.empty() ? otherwise : Vec3f{float(values[0]), float(values[1]), float(values[2])};
}

void check_transform(const GltfDocument& document, std::size_t index) {
  const tinygltf::Node& node = document.model->nodes[index];
  const std::string place = node_place(index);
  if (!node.matrix.empty()) check_affine(document, node.matrix, 1e-5, place + ".matrix");
  if (node.rotation.empty() || std::isfinite(unit_quaternion(node.rotation).w)) return;
  fail(document, place + ".rotation", "is of no direction", "a unit quaternion");
}

Mat4f local_transform(const tinygltf::Node& node) {
  if (node.matrix.empty()) {
    const Vec4f rotation = node.rotation.empty() ? Vec4f{0, 0, 0, 1} : unit_quaternion(node.rotation);
    return make_transform(vec3_or(node.translation, {0, 0, 0}), rotation, vec3_or(node.scale, {1, 1, 1}));
  }
  Mat4f transform;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) transform(row, column) = float(node.matrix[4 * column + row]);
  }
  return transform;
}

int light_of(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_lights_punctual");
  return extension == node.extensions.end() ? -1 : extension->second.Get("light").GetNumberAsInt();
}

template <class T>
std::vector<double> doubles(const T& v) {
  if constexpr (std::is_same_v<T, Vec4f>)
    return {v.x, v.y, v.z, v.w};
  else
    return {v.x, v.y, v.z};
}

Mat4f posed_transform(tinygltf::Node node, const NodePose& pose) {
  if (pose.translation) node.translation = doubles(*pose.translation);
  if (pose.rotation) node.rotation = doubles(*pose.rotation);
  if (pose.scale) node.scale = doubles(*pose.scale);
  return local_transform(node);
}

const NodePose* find_pose(const GltfPose& pose, int node) {
  const auto found = pose.find(node);
  return found == pose.end() ? nullptr : &found->second;
}

// The weights of the morph targets: as posed, else the node's, else the mesh's.
std::vector<float> weights_of(const GltfDocument& document, int index, const NodePose* pose) {
  const tinygltf::Node& node = document.model->nodes[index];
  if (node.mesh < 0) return {};
  if (pose != nullptr && !pose->weights.empty()) return pose->weights;
  const std::vector<double>& weights = node.weights.empty() ? document.model->meshes[node.mesh].weights : node.weights;
  return {weights.begin(), weights.end()};
}

bool is_hidden(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_node_visibility");
  return extension != node.extensions.end() && extension->second.Has("visible") &&
         !extension->second.Get("visible").Get<bool>();
}

// Of all nodes, in a file without scenes.
std::vector<int> roots_of(const GltfDocument& document, const std::vector<int>& parents) {
  if (const tinygltf::Scene* const scene = shown_scene(document)) return scene->nodes;
  std::vector<int> roots;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == kNoParent) roots.push_back(int(i));
  }
  return roots;
}

// Components of instance i, or the value they have without the attribute.
std::vector<double> instance_values(const std::vector<float>& values, std::size_t i, std::size_t components) {
  if (values.empty()) return {};
  return {values.begin() + std::ptrdiff_t(i * components), values.begin() + std::ptrdiff_t((i + 1) * components)};
}

}  // namespace

std::string place_of(const PlacedNode& node) { return node_place(std::size_t(node.node)); }

void check_affine(const GltfDocument& document, const std::vector<double>& matrix, double tolerance,
                  const std::string& place) {
  for (std::size_t i = 3; i < 16; i += 4) {
    if (std::abs(matrix[i] - (i == 15 ? 1 : 0)) <= tolerance) continue;
    fail(document, place, fmt::format("element {} is {:.6g}", i, matrix[i]),
         "0, 0, 0 and 1 as elements 3, 7, 11 and 15: columns, one after the other");
  }
}

void check_in_world(const GltfDocument& document, const PlacedNode& node, Vec3f point, const char* what) {
  if (in_world(point)) return;
  fail(document, place_of(node), fmt::format("puts {} at {:g}, {:g}, {:g}", what, point.x, point.y, point.z),
       fmt::format("within {:g} m of the origin", kWorldLimit));
}

// A node that no root leads to is part of a cycle.
std::vector<Mat4f> world_from_nodes(const GltfDocument& document, const GltfPose& pose) {
  const auto& nodes = document.model->nodes;
  const std::vector<int> parents = parents_of(document);
  std::vector<Mat4f> world(nodes.size());
  std::vector<int> waiting;
  std::size_t reached = 0;
  std::vector<bool> is_reached(nodes.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (parents[i] == kNoParent) waiting.push_back(int(i));
  }
  for (; !waiting.empty(); ++reached) {
    const int i = waiting.back();
    waiting.pop_back();
    const NodePose* posed = find_pose(pose, i);
    check_transform(document, std::size_t(i));
    const Mat4f local = posed == nullptr ? local_transform(nodes[i]) : posed_transform(nodes[i], *posed);
    world[i] = parents[i] == kNoParent ? local : world[parents[i]] * local;
    if (!is_finite(world[i])) fail(document, node_place(i), "its transform is not finite", "finite numbers");
    is_reached[i] = true;
    waiting.insert(waiting.end(), nodes[i].children.begin(), nodes[i].children.end());
  }
  if (reached < nodes.size()) {
    const auto looped = std::find(is_reached.begin(), is_reached.end(), false) - is_reached.begin();
    fail(document, node_place(looped), "is its own ancestor", "a hierarchy without cycles");
  }
  return world;
}

std::vector<PlacedNode> place_nodes(const GltfDocument& document, const GltfPose& pose) {
  const std::vector<Mat4f> world = world_from_nodes(document, pose);
  const std::vector<int> parents = parents_of(document);
  std::vector<int> waiting = roots_of(document, parents);
  std::reverse(waiting.begin(), waiting.end());
  std::vector<bool> visited(world.size(), false);
  std::vector<PlacedNode> nodes;
  while (!waiting.empty()) {
    const int i = waiting.back();
    waiting.pop_back();
    const tinygltf::Node& node = document.model->nodes[i];
    if (visited[i] || is_hidden(node)) continue;
    visited[i] = true;
    nodes.push_back({i, parents[std::size_t(i)], node.name, node.mesh, node.camera, light_of(node), node.skin,
                     weights_of(document, i, find_pose(pose, i)), world[i]});
    waiting.insert(waiting.end(), node.children.rbegin(), node.children.rend());
  }
  return nodes;
}

// Where only attributes of other programs (_ID) tell.
std::size_t unplaced_instances(const GltfDocument& document, const tinygltf::Value& attributes) {
  const std::vector<std::string> names = attributes.Keys();
  return names.empty() ? 0 : element_count(document, attributes.Get(names.front()).GetNumberAsInt());
}

std::vector<Mat4f> instance_transforms(const GltfDocument& document, const PlacedNode& node) {
  const auto& extensions = document.model->nodes[node.node].extensions;
  const auto extension = extensions.find("EXT_mesh_gpu_instancing");
  if (extension == extensions.end()) return {node.world_from_node};
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  std::size_t count = 0;
  const auto read = [&](const char* name, int components) {
    if (!attributes.Has(name)) return std::vector<float>{};
    const std::string place = fmt::format("{}.extensions.EXT_mesh_gpu_instancing.attributes.{}", place_of(node), name);
    std::vector<float> values = read_floats(document, attributes.Get(name).GetNumberAsInt(), components, place);
    const std::size_t elements = values.size() / std::size_t(components);
    if (count != 0 && elements != count)
      fail(document, place, fmt::format("has {} elements", elements), fmt::format("{}", count));
    count = elements;
    return values;
  };
  const std::vector<float> translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
                           scales = read("SCALE", 3);
  if (count == 0) count = unplaced_instances(document, attributes);
  std::vector<Mat4f> transforms(count);
  for (std::size_t i = 0; i < count; ++i) {
    tinygltf::Node copy;
    copy.translation = instance_values(translations, i, 3);
    copy.rotation = instance_values(rotations, i, 4);
    copy.scale = instance_values(scales, i, 3);
    transforms[i] = node.world_from_node * local_transform(copy);
    if (!is_finite(transforms[i]))
      fail(document, place_of(node), fmt::format("instance {} is not finite", i), "finite numbers");
  }
  return transforms;
}

}  // namespace chiaro::renderer
