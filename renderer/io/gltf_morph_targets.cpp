#include "renderer/io/gltf_morph_targets.h"

#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/io/gltf_accessors.h"

namespace chiaro::renderer {
namespace {

using Target = std::map<std::string, int>;

struct TargetContext {
  const GltfDocument& document;
  const Target& target;
  std::string place;
  float weight;
};

// Displacements have `components` floats; values have `stride`, of which the first ones move.
void add(const TargetContext& context, const std::string& name, int components, float* values, std::size_t count,
         std::size_t stride) {
  const auto found = context.target.find(name);
  if (found == context.target.end() || count == 0) return;
  const std::string place = fmt::format("{}.{}", context.place, name);
  const std::vector<float> moves = read_floats(context.document, found->second, components, place);
  if (moves.size() != count * std::size_t(components)) {
    fail(context.document, place, fmt::format("has {} elements", moves.size() / std::size_t(components)),
         fmt::format("{}, as POSITION", count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < std::size_t(components); ++c) {
      values[i * stride + c] += context.weight * moves[i * std::size_t(components) + c];
    }
  }
}

template <class T>
void add(const TargetContext& context, const std::string& name, int components, std::vector<T>& values) {
  add(context, name, components, reinterpret_cast<float*>(values.data()), values.size(), sizeof(T) / sizeof(float));
}

int components_of(const TargetContext& context, const std::string& name, int otherwise) {
  const auto found = context.target.find(name);
  return found == context.target.end() ? otherwise : accessor_components(context.document, found->second);
}

void add_target(const TargetContext& context, Mesh& mesh) {
  add(context, "POSITION", 3, mesh.positions);
  add(context, "NORMAL", 3, mesh.normals);
  add(context, "TANGENT", 3, mesh.tangents);
  for (std::size_t n = 0; n < mesh.uv.size(); ++n) add(context, fmt::format("TEXCOORD_{}", n), 2, mesh.uv[n]);
  add(context, "COLOR_0", std::clamp(components_of(context, "COLOR_0", 4), 3, 4), mesh.colors);
}

}  // namespace

void add_morph_targets(const GltfDocument& document, const GltfPrimitiveRef& ref, const std::vector<float>& weights,
                       Mesh& mesh) {
  const auto& targets = document.model->meshes[std::size_t(ref.mesh)].primitives[std::size_t(ref.primitive)].targets;
  const bool moves = std::any_of(weights.begin(), weights.end(), [](float weight) { return weight != 0; });
  if (!moves || targets.empty()) return;
  if (weights.size() != targets.size()) {
    fail(document, place_of(ref), fmt::format("has {} morph targets", targets.size()),
         fmt::format("{}, as there are weights", weights.size()));
  }
  for (std::size_t t = 0; t < weights.size(); ++t) {
    if (weights[t] == 0) continue;
    add_target({document, targets[t], fmt::format("{}.targets[{}]", place_of(ref), t), weights[t]}, mesh);
  }
  if (std::all_of(mesh.positions.begin(), mesh.positions.end(), [](Vec3f p) { return is_finite(p); })) return;
  fail(document, place_of(ref), "its morph targets put vertices at infinity", "finite numbers");
}

}  // namespace chiaro::renderer
