#include "renderer/io/gltf_draco.h"

#include <limits>
#include <memory>
#include <new>

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/control.h"
#include "renderer/io/draco_header.h"

namespace chiaro::renderer {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";

// Regular grids compress to almost nothing; beyond these a small file could ask for any amount of memory.
constexpr std::uint64_t kFacesOfAnyFile = 1U << 20, kFacesPerByte = 64;  // and as many points

struct CompressedPrimitive {
  int mesh = 0, primitive = 0;
  std::string place;
};

struct DecodedAccessor {
  std::string attribute;  // name among the primitive's attributes
  tinygltf::Accessor accessor;
  std::string bytes;
};

std::vector<CompressedPrimitive> compressed_primitives(const tinygltf::Model& model) {
  std::vector<CompressedPrimitive> compressed;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      if (!model.meshes[m].primitives[p].extensions.contains(kExtension)) continue;
      compressed.push_back({int(m), int(p), fmt::format("meshes[{}].primitives[{}].extensions.{}", m, p, kExtension)});
    }
  }
  return compressed;
}

void check_size(const GltfDocument& document, std::string_view bytes, const std::string& place) {
  const std::optional<DracoSizes> sizes = draco_sizes(bytes);
  if (!sizes) fail(document, place, "is damaged", "a mesh in Draco's format");
  const std::uint64_t most = kFacesOfAnyFile + kFacesPerByte * bytes.size();
  const auto require = [&](std::uint64_t count, const char* what) {
    if (count <= most) return;
    fail(document, place, fmt::format("says it has {} {}", count, what), fmt::format("at most {}", most));
  };
  require(sizes->faces, "triangles");
  require(sizes->points, "points");
}

std::unique_ptr<draco::Mesh> decode_mesh(const GltfDocument& document, std::string_view bytes,
                                         const std::string& place) {
  check_size(document, bytes, place);
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  try {
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (decoded.ok() && decoded.value()) return std::move(decoded).value();
  } catch (const std::bad_alloc&) {
    fail(document, place, "asks for more memory than there is", "data of Draco");
  } catch (const std::exception&) {  // a length that no container can have
  }
  fail(document, place, "is damaged", "a mesh in Draco's format");
}

template <class T>
bool copy_values(const draco::PointAttribute& attribute, std::size_t points, int components, std::string& bytes) {
  bytes.resize(points * std::size_t(components) * sizeof(T));
  T* to = reinterpret_cast<T*>(bytes.data());
  for (std::size_t i = 0; i < points; ++i, to += components) {
    const auto value = attribute.mapped_index(draco::PointIndex(std::uint32_t(i)));
    if (value.value() >= attribute.size() || !attribute.ConvertValue<T>(value, std::int8_t(components), to))
      return false;
  }
  return true;
}

bool copy_values(const draco::PointAttribute& attribute, std::size_t points, const tinygltf::Accessor& accessor,
                 std::string& bytes) {
  const int components = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return copy_values<std::int8_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return copy_values<std::uint8_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return copy_values<std::int16_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return copy_values<std::uint16_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return copy_values<std::uint32_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return copy_values<float>(attribute, points, components, bytes);
    default:
      return false;
  }
}

DecodedAccessor decode_attribute(const GltfDocument& document, const draco::Mesh& mesh, int accessor, int id,
                                 const std::string& place) {
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(std::uint32_t(id));
  if (attribute == nullptr) fail(document, place, fmt::format("attribute {} is not in the data", id), "one that is");
  DecodedAccessor decoded;
  decoded.accessor = document.model->accessors[std::size_t(accessor)];
  const int components = tinygltf::GetNumComponentsInType(std::uint32_t(decoded.accessor.type));
  if (components != attribute->num_components()) {
    fail(document, place, fmt::format("attribute {} has {} components", id, attribute->num_components()),
         fmt::format("{}, as accessors[{}]", components, accessor));
  }
  decoded.accessor.count = mesh.num_points();
  if (!copy_values(*attribute, mesh.num_points(), decoded.accessor, decoded.bytes)) {
    fail(document, place, fmt::format("attribute {} does not fit accessors[{}]", id, accessor),
         "as many values of its type");
  }
  return decoded;
}

DecodedAccessor decode_indices(const draco::Mesh& mesh) {
  static_assert(sizeof(draco::Mesh::Face) == 3 * sizeof(std::uint32_t));
  DecodedAccessor decoded;
  decoded.attribute = kIndicesAttribute;
  decoded.accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  decoded.accessor.type = TINYGLTF_TYPE_SCALAR;
  decoded.accessor.count = 3 * std::size_t(mesh.num_faces());
  decoded.bytes.reserve(decoded.accessor.count * sizeof(std::uint32_t));
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    decoded.bytes.append(reinterpret_cast<const char*>(face.data()), sizeof face);
  }
  return decoded;
}

std::vector<DecodedAccessor> decode_primitive(const GltfDocument& document, const CompressedPrimitive& compressed) {
  const tinygltf::Primitive& primitive =
      document.model->meshes[std::size_t(compressed.mesh)].primitives[std::size_t(compressed.primitive)];
  const tinygltf::Value& extension = primitive.extensions.at(kExtension);
  const std::string_view bytes = buffer_view_bytes(document, extension.Get("bufferView").GetNumberAsInt());
  const std::unique_ptr<draco::Mesh> mesh = decode_mesh(document, bytes, compressed.place);
  std::vector<DecodedAccessor> decoded;
  decoded.push_back(decode_indices(*mesh));
  const tinygltf::Value& attributes = extension.Get("attributes");
  for (const std::string& name : attributes.Keys()) {
    const auto accessor = primitive.attributes.find(name);
    if (accessor == primitive.attributes.end()) continue;
    decoded.push_back(decode_attribute(document, *mesh, accessor->second, attributes.Get(name).GetNumberAsInt(),
                                       fmt::format("{}.attributes.{}", compressed.place, name)));
    decoded.back().attribute = name;
  }
  return decoded;
}

void add_accessors(GltfDocument& document, tinygltf::Model& model, const CompressedPrimitive& compressed,
                   std::vector<DecodedAccessor> decoded) {
  tinygltf::Primitive& primitive =
      model.meshes[std::size_t(compressed.mesh)].primitives[std::size_t(compressed.primitive)];
  primitive.mode = TINYGLTF_MODE_TRIANGLES;  // strips are decoded to lists
  for (DecodedAccessor& one : decoded) {
    one.accessor.bufferView = -1;
    one.accessor.sparse.isSparse = false;
    primitive.attributes[one.attribute] = int(model.accessors.size());
    document.decoded_accessors[int(model.accessors.size())] = std::move(one.bytes);
    model.accessors.push_back(std::move(one.accessor));
  }
}

}  // namespace

void decode_draco_primitives(GltfDocument& document) {
  const std::vector<CompressedPrimitive> compressed = compressed_primitives(*document.model);
  if (compressed.empty()) return;
  std::vector<std::vector<DecodedAccessor>> decoded(compressed.size());
  parallel_for(compressed.size(), [&](std::size_t i) { decoded[i] = decode_primitive(document, compressed[i]); });
  auto model = std::make_shared<tinygltf::Model>(*document.model);
  for (std::size_t i = 0; i < compressed.size(); ++i) {
    add_accessors(document, *model, compressed[i], std::move(decoded[i]));
  }
  document.model = std::move(model);
}

}  // namespace chiaro::renderer
