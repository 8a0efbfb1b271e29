#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace chiaro::renderer {

// Whether the name ends in one of these (".exr", lower case); its own case does not matter.
bool has_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

}  // namespace chiaro::renderer
