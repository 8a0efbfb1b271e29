#pragma once
// The JSON of a glTF file, checked, so that whoever reads it afterwards meets no index out of range and no wrong type.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace chiaro::renderer {

inline constexpr const char* kIndicesAttribute = "indices";

struct GltfBufferSource {
  std::optional<std::string> uri;  // absent: the BIN chunk, or nothing
  std::size_t byte_length = 0;
};

struct GltfImageSource {
  std::string name;
  std::optional<std::string> uri;
  int buffer_view = -1;  // where there is no uri
};

struct GltfJson {
  // All but what stands below, and animations and skins. A primitive's indices stand among its attributes under the
  // name kIndicesAttribute, as tinygltf refuses index accessors without a buffer view, which are allowed.
  std::string structure;
  std::vector<std::string> extensions_used, extensions_required;
  std::vector<GltfBufferSource> buffers;
  std::vector<GltfImageSource> images;
  bool has_animations = false, has_skins = false, has_morph_targets = false;
};

// Error, naming `path` and the place, for what is not JSON or not glTF 2.0, for values of wrong types, for indices that
// point at nothing, and for numbers that floats cannot hold.
GltfJson check_gltf_json(const std::string& text, const std::filesystem::path& path);

}  // namespace chiaro::renderer
