#include "renderer/core/external_files.h"

#include <algorithm>
#include <system_error>

namespace chiaro::renderer {

bool is_in_folder(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code missing;
  const std::filesystem::path inner = std::filesystem::canonical(file, missing);
  if (missing) return false;
  const std::filesystem::path outer = std::filesystem::canonical(folder.empty() ? "." : folder, missing);
  if (missing) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace chiaro::renderer
