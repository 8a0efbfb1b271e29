#pragma once
// URIs of buffers and images: data URIs, and files beside the glTF.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/core/external_files.h"

namespace chiaro::renderer {

// The file that has the URIs.
struct UriBase {
  std::filesystem::path gltf;
  ExternalFiles external = ExternalFiles::kInFolder;
};

// What `uri` refers to: the bytes of a data URI, or of a file relative to the glTF file, its name percent-encoded or
// not. Error, naming that, `place` and the file, for what is missing, not a file, not allowed, or not well formed.
std::string read_uri(const std::string& uri, const UriBase& base, const std::string& place);

bool is_data_uri(std::string_view uri);

// What the file that `uri` refers to may be called: a name with a percent sign in it is as good as an encoded one.
std::vector<std::string> file_names_of(const std::string& uri);

// "data:MIME;base64,…"
std::string make_data_uri(std::string_view mime_type, std::string_view bytes);

}  // namespace chiaro::renderer
