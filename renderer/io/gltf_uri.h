#pragma once
// URIs of buffers and images: data URIs, and files beside the glTF.

#include <filesystem>
#include <string>
#include <string_view>

namespace chiaro::renderer {

// What `uri` refers to: the bytes of a data URI, or of a file relative to `gltf`, its name percent-encoded or not.
// Error, naming `gltf`, `place` and the file, for what is missing, not a file, or not well formed.
std::string read_uri(const std::string& uri, const std::filesystem::path& gltf, const std::string& place);

bool is_data_uri(std::string_view uri);

// "data:MIME;base64,…"
std::string make_data_uri(std::string_view mime_type, std::string_view bytes);

}  // namespace chiaro::renderer
