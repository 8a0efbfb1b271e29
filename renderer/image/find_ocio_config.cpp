#include <cstdlib>

#include "renderer/core/error.h"
#include "renderer/image/color_management.h"

namespace chiaro::renderer {
namespace {

std::optional<std::filesystem::path> data_config() {
  std::vector<std::filesystem::path> folders;
  if (const char* data = std::getenv("CHIARO_DATA")) folders.emplace_back(data);
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path prefix = program.parent_path().parent_path();
  if (!prefix.empty()) folders.insert(folders.end(), {prefix, prefix / "share" / "chiaro"});
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path config = folder / "color" / "config.ocio";
    if (std::filesystem::is_regular_file(config, ignored)) return config;
  }
  return std::nullopt;
}

std::filesystem::path checked(const std::filesystem::path& config, const char* where) {
  if (config.string().starts_with("ocio://")) return config;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(config, ignored)) return config;
  throw Error({config.string(), where, "no such file", "an OpenColorIO config"});
}

}  // namespace

std::filesystem::path find_ocio_config(const std::optional<std::filesystem::path>& explicit_config) {
  if (explicit_config) return checked(*explicit_config, "");
  if (const char* variable = std::getenv("OCIO"); variable && *variable) return checked(variable, "$OCIO");
  if (const auto config = data_config()) return *config;
  throw Error({"config.ocio", "", "no OpenColorIO config found", "--ocio, $OCIO, or $CHIARO_DATA/color/config.ocio"});
}

}  // namespace chiaro::renderer
