#pragma once
// Accessors as plain arrays: every component type, normalised integers, strides, sparse ones.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/io/gltf_document.h"

namespace chiaro::renderer {

// Number of elements, as the accessor says.
std::size_t accessor_count(const GltfDocument& document, int accessor);

// Components per element: SCALAR 1, VEC2 2, …
int accessor_components(const GltfDocument& document, int accessor);

bool accessor_is_float(const GltfDocument& document, int accessor);
bool accessor_is_unsigned(const GltfDocument& document, int accessor);

// Error where it reaches beyond its buffer, or is malformed.
std::size_t element_count(const GltfDocument& document, int accessor);

// Elements one after the other. Error, naming `place`, where the accessor has other than `components` components,
// reaches beyond its buffer, or is malformed.
std::vector<float> read_floats(const GltfDocument& document, int accessor, int components, const std::string& place);

std::vector<Vec2f> read_vec2(const GltfDocument& document, int accessor, const std::string& place);
std::vector<Vec3f> read_vec3(const GltfDocument& document, int accessor, const std::string& place);
std::vector<Vec4f> read_vec4(const GltfDocument& document, int accessor, const std::string& place);

// Of an unsigned SCALAR accessor.
std::vector<std::uint32_t> read_indices(const GltfDocument& document, int accessor, const std::string& place);

}  // namespace chiaro::renderer
