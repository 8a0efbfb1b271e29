#include "renderer/core/file_extension.h"

#include <algorithm>
#include <cctype>

namespace chiaro::renderer {

bool has_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

}  // namespace chiaro::renderer
