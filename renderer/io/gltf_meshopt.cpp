#include "renderer/io/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include "renderer/core/control.h"

namespace chiaro::renderer {
namespace {

// Of its vertex codec, where blocks of 256 equal bytes take 4; the others compress less.
constexpr std::size_t kMostExpansion = 64;

std::string place_of(int view) { return fmt::format("bufferViews[{}].extensions.EXT_meshopt_compression", view); }

std::string_view compressed_bytes(const GltfDocument& document, int view, const GltfMeshoptView& source) {
  const std::string& buffer = document.buffers[std::size_t(source.buffer)];
  if (source.byte_offset <= buffer.size() && source.byte_length <= buffer.size() - source.byte_offset) {
    return std::string_view(buffer).substr(source.byte_offset, source.byte_length);
  }
  fail(document, place_of(view),
       fmt::format("{} bytes at {} reach beyond buffers[{}]", source.byte_length, source.byte_offset, source.buffer),
       fmt::format("at most {} bytes", buffer.size()));
}

void check_stride(const GltfDocument& document, int view, const GltfMeshoptView& source) {
  const std::size_t stride = source.byte_stride;
  const bool is_index = source.mode != "ATTRIBUTES";
  const bool fits = is_index ? stride == 2 || stride == 4 : stride > 0 && stride <= 256 && stride % 4 == 0;
  if (fits) return;
  fail(document, place_of(view) + ".byteStride", fmt::format("is {} in mode {}", stride, source.mode.substr(0, 40)),
       is_index ? "2 or 4" : "a multiple of 4, at most 256");
}

void check_filter(const GltfDocument& document, int view, const GltfMeshoptView& source) {
  const std::string& filter = source.filter;
  const std::size_t stride = source.byte_stride;
  if (filter == "NONE" || (filter == "EXPONENTIAL" && stride % 4 == 0)) return;
  if ((filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) || (filter == "QUATERNION" && stride == 8)) return;
  fail(document, place_of(view) + ".filter", fmt::format("is {} with byteStride {}", filter.substr(0, 40), stride),
       "NONE, OCTAHEDRAL (4 or 8), QUATERNION (8) or EXPONENTIAL");
}

std::size_t checked_size(const GltfDocument& document, int view, const GltfMeshoptView& source) {
  if (source.mode != "ATTRIBUTES" && source.mode != "TRIANGLES" && source.mode != "INDICES") {
    fail(document, place_of(view) + ".mode", fmt::format("is \"{}\"", source.mode.substr(0, 40)),
         "ATTRIBUTES, TRIANGLES or INDICES");
  }
  check_stride(document, view, source);
  check_filter(document, view, source);
  if (source.mode == "TRIANGLES" && source.count % 3 != 0) {
    fail(document, place_of(view) + ".count", fmt::format("is {}", source.count), "a multiple of 3");
  }
  if (source.count / kMostExpansion > source.byte_length / source.byte_stride) {
    fail(document, place_of(view) + ".count", fmt::format("{} elements in {} bytes", source.count, source.byte_length),
         fmt::format("at most {} times the size", kMostExpansion));
  }
  return source.count * source.byte_stride;
}

bool decode(const GltfMeshoptView& source, std::string_view compressed, std::string& bytes) {
  const auto* from = reinterpret_cast<const unsigned char*>(compressed.data());
  char* to = bytes.data();
  const std::size_t count = source.count, stride = source.byte_stride, size = compressed.size();
  if (source.mode == "TRIANGLES") return meshopt_decodeIndexBuffer(to, count, stride, from, size) == 0;
  if (source.mode == "INDICES") return meshopt_decodeIndexSequence(to, count, stride, from, size) == 0;
  return meshopt_decodeVertexBuffer(to, count, stride, from, size) == 0;
}

void apply_filter(const GltfMeshoptView& source, std::string& bytes) {
  if (source.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), source.count, source.byte_stride);
  if (source.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), source.count, source.byte_stride);
  if (source.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), source.count, source.byte_stride);
}

// Accessors go by the view itself.
void check_view(const GltfDocument& document, int view, const GltfMeshoptView& source) {
  const tinygltf::BufferView& plain = document.model->bufferViews[std::size_t(view)];
  const auto check = [&](const char* name, std::size_t value, std::size_t expected) {
    if (value == expected) return;
    fail(document, fmt::format("bufferViews[{}].{}", view, name), fmt::format("is {}", value),
         fmt::format("{}, as EXT_meshopt_compression has it", expected));
  };
  if (plain.byteStride != 0) check("byteStride", plain.byteStride, source.byte_stride);
  check("byteLength", plain.byteLength, source.count * source.byte_stride);
}

std::string decode_view(const GltfDocument& document, int view, const GltfMeshoptView& source) {
  const std::string_view compressed = compressed_bytes(document, view, source);
  std::string bytes(checked_size(document, view, source), '\0');
  if (!decode(source, compressed, bytes)) fail(document, place_of(view), "is damaged", "meshoptimizer's format");
  check_view(document, view, source);
  apply_filter(source, bytes);
  return bytes;
}

// Views may share their bytes.
void require_sensible_sum(const GltfDocument& document, const std::vector<std::pair<int, GltfMeshoptView>>& views) {
  std::size_t compressed = 0, decoded = 0;
  for (const std::string& buffer : document.buffers) compressed += buffer.size();
  for (const auto& [view, source] : views) {
    decoded += checked_size(document, view, source);
    if (decoded / kMostExpansion <= compressed) continue;
    fail(document, place_of(view), fmt::format("{} bytes come of buffers of {} up to here", decoded, compressed),
         fmt::format("at most {} times the size", kMostExpansion));
  }
}

}  // namespace

void decode_meshopt_views(GltfDocument& document) {
  const std::vector<std::pair<int, GltfMeshoptView>> views(document.json.meshopt_views.begin(),
                                                           document.json.meshopt_views.end());
  require_sensible_sum(document, views);
  std::vector<std::string> decoded(views.size());
  parallel_for(views.size(),
               [&](std::size_t i) { decoded[i] = decode_view(document, views[i].first, views[i].second); });
  for (std::size_t i = 0; i < views.size(); ++i) document.decoded_views[views[i].first] = std::move(decoded[i]);
}

}  // namespace chiaro::renderer
