#include "renderer/io/gltf_variants.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tiny_gltf.h>

namespace chiaro::renderer {
namespace {

constexpr const char* kExtension = "KHR_materials_variants";

bool names_variant(const tinygltf::Value& mapping, int variant) {
  const tinygltf::Value& variants = mapping.Get("variants");
  for (int i = 0; i < int(variants.ArrayLen()); ++i) {
    if (variants.Get(i).GetNumberAsInt() == variant) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> variant_names(const GltfDocument& document) {
  std::vector<std::string> names;
  const auto found = document.model->extensions.find(kExtension);
  if (found == document.model->extensions.end()) return names;
  const tinygltf::Value& variants = found->second.Get("variants");
  for (int i = 0; i < int(variants.ArrayLen()); ++i) {
    names.push_back(variants.Get(i).Get("name").Get<std::string>());
  }
  return names;
}

int find_variant(const GltfDocument& document, const std::string& name) {
  if (name.empty()) return -1;
  const std::vector<std::string> names = variant_names(document);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return int(found - names.begin());
  const std::string expected =
      names.empty() ? "none: it has no KHR_materials_variants" : fmt::format("one of: {}", fmt::join(names, ", "));
  fail(document, "KHR_materials_variants", fmt::format("there is no variant \"{}\"", name), expected);
}

int material_in_variant(const GltfDocument& document, const GltfPrimitiveRef& ref, int variant, int own) {
  if (variant < 0) return own;
  const auto& extensions = document.model->meshes[ref.mesh].primitives[ref.primitive].extensions;
  const auto found = extensions.find(kExtension);
  if (found == extensions.end()) return own;
  const tinygltf::Value& mappings = found->second.Get("mappings");
  for (int i = 0; i < int(mappings.ArrayLen()); ++i) {
    const tinygltf::Value& mapping = mappings.Get(i);
    if (names_variant(mapping, variant)) return mapping.Get("material").GetNumberAsInt();
  }
  return own;
}

}  // namespace chiaro::renderer
