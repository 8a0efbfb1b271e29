#pragma once
// The JSON of a glTF file, checked, so that whoever reads it afterwards meets no index out of range and no wrong type.

#include <cstddef>
#include <filesystem>
#include <map>
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

// EXT_meshopt_compression of a buffer view.
struct GltfMeshoptView {
  int buffer = 0;
  std::size_t byte_offset = 0, byte_length = 0, byte_stride = 0, count = 0;
  std::string mode, filter = "NONE";
};

struct GltfSkin {
  std::vector<int> joints;  // nodes
  int inverse_bind_matrices = -1;
};

struct GltfAnimationSampler {
  int input = 0, output = 0;
  std::string interpolation = "LINEAR";
};

struct GltfAnimationChannel {
  int sampler = 0, node = -1;
  std::string path;
};

struct GltfAnimation {
  std::string name;
  std::vector<GltfAnimationSampler> samplers;
  std::vector<GltfAnimationChannel> channels;
};

struct GltfJson {
  // All but what stands below. A primitive's indices stand among its attributes under the
  // name kIndicesAttribute, as tinygltf refuses index accessors without a buffer view, which are allowed.
  std::string structure;
  std::size_t size = 0;  // of the text, in bytes
  std::vector<std::string> extensions_used, extensions_required;
  std::vector<GltfBufferSource> buffers;
  std::vector<GltfImageSource> images;
  std::map<int, GltfMeshoptView> meshopt_views;  // by buffer view
  std::vector<GltfSkin> skins;
  std::vector<GltfAnimation> animations;
};

// Error, naming `path` and the place, for what is not JSON or not glTF 2.0, for values of wrong types, for indices that
// point at nothing, and for numbers that floats cannot hold.
GltfJson check_gltf_json(const std::string& text, const std::filesystem::path& path);

}  // namespace chiaro::renderer
