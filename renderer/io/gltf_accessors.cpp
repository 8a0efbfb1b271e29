#include "renderer/io/gltf_accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

// Elements in memory that are known to be there.
struct Elements {
  const char* first = nullptr;  // none: all zero
  std::size_t stride = 0, count = 0;
  int components = 0, component_type = 0;
  bool normalized = false;
};

std::size_t component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_INT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

int component_count(int type, int component_type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    case TINYGLTF_TYPE_MAT4:
      return component_type == TINYGLTF_COMPONENT_TYPE_FLOAT ? 16 : 0;
    default:
      return 0;  // other matrices are not used
  }
}

std::string place_of(int accessor) { return fmt::format("accessors[{}]", accessor); }

// Points `elements` at `offset` in a buffer view, where they must lie whole.
void locate(const GltfDocument& document, Elements& elements, int buffer_view, std::size_t offset,
            const std::string& place) {
  const std::string_view bytes = buffer_view_bytes(document, buffer_view);
  const std::size_t element = component_size(elements.component_type) * elements.components;
  if (elements.stride == 0) elements.stride = element;
  if (elements.stride < element) {
    fail(document, place, fmt::format("byteStride {} is less than an element", elements.stride),
         fmt::format("at least {}", element));
  }
  const bool fits =
      offset <= bytes.size() &&
      (elements.count == 0 ||
       (bytes.size() - offset >= element && (bytes.size() - offset - element) / elements.stride >= elements.count - 1));
  if (!fits) {
    fail(document, place,
         fmt::format("{} elements of {} bytes at {} reach beyond bufferViews[{}]", elements.count, element, offset,
                     buffer_view),
         fmt::format("at most {} bytes", bytes.size()));
  }
  elements.first = bytes.data() + offset;
}

// Nothing in the file backs the count of an accessor without data, so that a small file could ask for any amount.
void check_unbacked_count(const GltfDocument& document, const tinygltf::Accessor& accessor, const std::string& place) {
  std::size_t limit = 65536;
  for (const std::string& buffer : document.buffers) limit += buffer.size();
  if (accessor.count > limit) {
    fail(document, place, fmt::format("{} elements without a bufferView", accessor.count), "as many as there is data");
  }
}

Elements elements_of(const GltfDocument& document, int index) {
  const tinygltf::Accessor& accessor = document.model->accessors[index];
  const std::string place = place_of(index);
  Elements elements;
  elements.count = accessor.count;
  elements.components = component_count(accessor.type, accessor.componentType);
  elements.component_type = accessor.componentType;
  elements.normalized = accessor.normalized;
  if (elements.components == 0)
    fail(document, place + ".type", "is a matrix that is not used", "SCALAR, VEC2, VEC3, VEC4, or MAT4 of floats");
  if (component_size(accessor.componentType) == 0) {
    fail(document, place + ".componentType", fmt::format("is {}", accessor.componentType), "5120 to 5126");
  }
  const auto decoded = document.decoded_accessors.find(index);
  if (decoded != document.decoded_accessors.end()) {
    elements.stride = component_size(elements.component_type) * elements.components;
    elements.first = decoded->second.data();
    CHIARO_CHECK(decoded->second.size() == elements.stride * elements.count);
  } else if (accessor.bufferView >= 0) {
    elements.stride = document.model->bufferViews[accessor.bufferView].byteStride;
    locate(document, elements, accessor.bufferView, accessor.byteOffset, place);
  } else {
    check_unbacked_count(document, accessor, place);
  }
  return elements;
}

template <class T>
T load(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// glTF 2.0, section 3.6.2.2: max(c / largest, -1).
template <class T>
float normalized_value(T value) {
  return std::max(float(double(value) / double(std::numeric_limits<T>::max())), -1.0F);
}

template <class T>
void copy_as_float(const Elements& elements, const std::uint32_t* targets, float* out) {
  for (std::size_t i = 0; i < elements.count; ++i) {
    float* to = out + (targets ? targets[i] : i) * elements.components;
    for (int c = 0; c < elements.components; ++c) {
      const T value = load<T>(elements.first + i * elements.stride + c * sizeof(T));
      if constexpr (std::is_same_v<T, float>) {
        to[c] = value;
      } else {
        to[c] = elements.normalized ? normalized_value(value) : float(value);
      }
    }
  }
}

template <class T>
void copy_as_index(const Elements& elements, const std::uint32_t* targets, std::uint32_t* out) {
  for (std::size_t i = 0; i < elements.count; ++i) {
    out[targets ? targets[i] : i] = std::uint32_t(load<T>(elements.first + i * elements.stride));
  }
}

// `targets`: where each element goes; none: one after the other.
void copy(const Elements& elements, const std::uint32_t* targets, float* out) {
  if (!elements.first) return;
  switch (elements.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return copy_as_float<std::int8_t>(elements, targets, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return copy_as_float<std::uint8_t>(elements, targets, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return copy_as_float<std::int16_t>(elements, targets, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return copy_as_float<std::uint16_t>(elements, targets, out);
    case TINYGLTF_COMPONENT_TYPE_INT:
      return copy_as_float<std::int32_t>(elements, targets, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return copy_as_float<std::uint32_t>(elements, targets, out);
    default:
      return copy_as_float<float>(elements, targets, out);
  }
}

void copy(const Elements& elements, const std::uint32_t* targets, std::uint32_t* out) {
  if (!elements.first) return;
  switch (elements.component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return copy_as_index<std::uint8_t>(elements, targets, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return copy_as_index<std::uint16_t>(elements, targets, out);
    default:
      return copy_as_index<std::uint32_t>(elements, targets, out);
  }
}

bool is_unsigned(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::vector<std::uint32_t> sparse_targets(const GltfDocument& document, const tinygltf::Accessor& accessor,
                                          const std::string& place) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || std::size_t(sparse.count) > accessor.count) {
    fail(document, place + ".count", fmt::format("is {}", sparse.count), fmt::format("at most {}", accessor.count));
  }
  if (!is_unsigned(sparse.indices.componentType)) {
    fail(document, place + ".indices.componentType", fmt::format("is {}", sparse.indices.componentType),
         "an unsigned type");
  }
  Elements indices{nullptr, 0, std::size_t(sparse.count), 1, sparse.indices.componentType, false};
  locate(document, indices, sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), place + ".indices");
  std::vector<std::uint32_t> targets(indices.count);
  copy(indices, nullptr, targets.data());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (targets[i] >= accessor.count) {
      fail(document, place + ".indices", fmt::format("{} is out of range", targets[i]),
           fmt::format("less than {}", accessor.count));
    }
    if (i > 0 && targets[i] <= targets[i - 1]) {
      fail(document, place + ".indices", fmt::format("{} comes after {}", targets[i], targets[i - 1]),
           "each larger than the one before");
    }
  }
  return targets;
}

template <class T>
void apply_sparse(const GltfDocument& document, int index, const Elements& elements, T* out) {
  const tinygltf::Accessor& accessor = document.model->accessors[index];
  if (!accessor.sparse.isSparse) return;
  const std::string place = place_of(index) + ".sparse";
  const std::vector<std::uint32_t> targets = sparse_targets(document, accessor, place);
  Elements values = elements;
  values.count = targets.size();
  values.stride = 0;
  locate(document, values, accessor.sparse.values.bufferView, std::size_t(accessor.sparse.values.byteOffset),
         place + ".values");
  copy(values, targets.data(), out);
}

// T: a vector of `components` floats without padding.
template <class T>
std::vector<T> read(const GltfDocument& document, int accessor, int components, const std::string& place) {
  const Elements elements = elements_of(document, accessor);
  if (elements.components != components) {
    fail(document, place, fmt::format("{} has {} components", place_of(accessor), elements.components),
         fmt::format("{}", components));
  }
  std::vector<T> values(elements.count * components * sizeof(float) / sizeof(T));
  float* out = reinterpret_cast<float*>(values.data());
  copy(elements, nullptr, out);
  apply_sparse(document, accessor, elements, out);
  return values;
}

}  // namespace

std::size_t accessor_count(const GltfDocument& document, int accessor) {
  return document.model->accessors[accessor].count;
}

int accessor_components(const GltfDocument& document, int accessor) {
  return component_count(document.model->accessors[accessor].type, document.model->accessors[accessor].componentType);
}

bool accessor_is_float(const GltfDocument& document, int accessor) {
  return document.model->accessors[accessor].componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

bool accessor_is_unsigned(const GltfDocument& document, int accessor) {
  return is_unsigned(document.model->accessors[accessor].componentType);
}

std::size_t element_count(const GltfDocument& document, int accessor) { return elements_of(document, accessor).count; }

std::vector<float> read_floats(const GltfDocument& document, int accessor, int components, const std::string& place) {
  return read<float>(document, accessor, components, place);
}

std::vector<Vec2f> read_vec2(const GltfDocument& document, int accessor, const std::string& place) {
  return read<Vec2f>(document, accessor, 2, place);
}

std::vector<Vec3f> read_vec3(const GltfDocument& document, int accessor, const std::string& place) {
  return read<Vec3f>(document, accessor, 3, place);
}

std::vector<Vec4f> read_vec4(const GltfDocument& document, int accessor, const std::string& place) {
  return read<Vec4f>(document, accessor, 4, place);
}

std::vector<std::uint32_t> read_indices(const GltfDocument& document, int accessor, const std::string& place) {
  const Elements elements = elements_of(document, accessor);
  if (elements.components != 1 || !is_unsigned(elements.component_type)) {
    fail(document, place, fmt::format("{} is not of unsigned scalars", place_of(accessor)),
         "SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT");
  }
  std::vector<std::uint32_t> indices(elements.count);
  copy(elements, nullptr, indices.data());
  apply_sparse(document, accessor, elements, indices.data());
  return indices;
}

}  // namespace chiaro::renderer
