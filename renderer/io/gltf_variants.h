#pragma once
// KHR_materials_variants.

#include <string>
#include <vector>

#include "renderer/io/gltf_document.h"
#include "renderer/io/gltf_primitives.h"

namespace chiaro::renderer {

std::vector<std::string> variant_names(const GltfDocument& document);

// Its index; -1 for an empty name: the materials that primitives have of their own. Error that lists the names for one
// that the file does not have.
int find_variant(const GltfDocument& document, const std::string& name);

// The material of a primitive in a variant; `own` where the variant says nothing of it.
int material_in_variant(const GltfDocument& document, const GltfPrimitiveRef& ref, int variant, int own);

}  // namespace chiaro::renderer
