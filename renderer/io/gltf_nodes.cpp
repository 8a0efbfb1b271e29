#include "renderer/io/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tiny_gltf.h>

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

Vec4f unit_quaternion(const std::vector<double>& q) {
  const double l = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(l > 0) || !std::isfinite(l)) return {0, 0, 0, 1};
  return {float(q[0] / l), float(q[1] / l), float(q[2] / l), float(q[3] / l)};
}

Vec3f vec3_or(const std::vector<double>& values, Vec3f otherwise) {
  return values.empty() ? otherwise : Vec3f{float(values[0]), float(values[1]), float(values[2])};
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

bool is_finite(const Mat4f& transform) {
  return std::all_of(transform.m.begin(), transform.m.end(), [](float v) { return std::isfinite(v); });
}

int light_of(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_lights_punctual");
  return extension == node.extensions.end() ? -1 : extension->second.Get("light").GetNumberAsInt();
}

PlacedNode placed(const tinygltf::Node& node, int index, const Mat4f& world_from_node) {
  return {index, node.name, node.mesh, node.camera, light_of(node), world_from_node};
}

// World transforms of all nodes, whatever scene they are in. A node that no root leads to is part of a cycle.
std::vector<PlacedNode> place_all(const GltfDocument& document, const std::vector<int>& parents) {
  const auto& nodes = document.model->nodes;
  std::vector<PlacedNode> all(nodes.size());
  std::vector<int> waiting;
  std::size_t reached = 0;
  std::vector<bool> is_reached(nodes.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (parents[i] == kNoParent) waiting.push_back(int(i));
  }
  for (; !waiting.empty(); ++reached) {
    const int i = waiting.back();
    waiting.pop_back();
    const Mat4f local = local_transform(nodes[i]);
    all[i] = placed(nodes[i], i, parents[i] == kNoParent ? local : all[parents[i]].world_from_node * local);
    if (!is_finite(all[i].world_from_node)) fail(document, node_place(i), "its transform is not finite");
    is_reached[i] = true;
    waiting.insert(waiting.end(), nodes[i].children.begin(), nodes[i].children.end());
  }
  if (reached < nodes.size()) {
    const auto looped = std::find(is_reached.begin(), is_reached.end(), false) - is_reached.begin();
    fail(document, node_place(looped), "is its own ancestor", "a hierarchy without cycles");
  }
  return all;
}

std::vector<int> roots_of(const GltfDocument& document, const std::vector<int>& parents) {
  if (document.model->defaultScene >= 0) return document.model->scenes[document.model->defaultScene].nodes;
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

std::vector<PlacedNode> place_nodes(const GltfDocument& document) {
  const std::vector<int> parents = parents_of(document);
  const std::vector<PlacedNode> all = place_all(document, parents);
  std::vector<int> waiting = roots_of(document, parents);
  std::reverse(waiting.begin(), waiting.end());
  std::vector<bool> visited(all.size(), false);
  std::vector<PlacedNode> nodes;
  while (!waiting.empty()) {
    const int i = waiting.back();
    waiting.pop_back();
    if (visited[i]) continue;
    visited[i] = true;
    nodes.push_back(all[i]);
    const std::vector<int>& children = document.model->nodes[i].children;
    waiting.insert(waiting.end(), children.rbegin(), children.rend());
  }
  return nodes;
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
  std::vector<Mat4f> transforms(count);
  for (std::size_t i = 0; i < count; ++i) {
    tinygltf::Node copy;
    copy.translation = instance_values(translations, i, 3);
    copy.rotation = instance_values(rotations, i, 4);
    copy.scale = instance_values(scales, i, 3);
    transforms[i] = node.world_from_node * local_transform(copy);
    if (!is_finite(transforms[i])) fail(document, place_of(node), fmt::format("instance {} is not finite", i));
  }
  return transforms;
}

}  // namespace chiaro::renderer
