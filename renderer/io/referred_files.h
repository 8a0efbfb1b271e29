#pragma once
// Which files are read with a scene or a light file.

#include <filesystem>
#include <vector>

namespace chiaro::renderer {

// The files that `file` names, whether they are there or not: buffers and images of glTF, images of a light file. Found
// without loading any of them. None for files of other kinds, and for pipes; one that is damaged may name fewer.
std::vector<std::filesystem::path> referred_files(const std::filesystem::path& file);

}  // namespace chiaro::renderer
