#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/light.h"

namespace chiaro::renderer {

// A light file: .glb/.gltf with KHR_lights_punctual, or JSON {"lights":[{"type":"point","position":[x,y,z],
// "intensity":[r,g,b]}, …]} (types and fields: the README's "Light files"). Error, naming the light and field, where a
// value is missing, of the wrong kind, not finite or negative, where a direction is zero, or where there are no lights.
// The image of an environment is a file in the light file's own folder or below; `config` is for it, as
// load_environment takes it.
Lights load_lights(const std::filesystem::path& path, std::vector<std::string>& warnings,
                   const std::optional<std::filesystem::path>& config = std::nullopt);
// The same, without its warnings.
Lights load_lights(const std::filesystem::path& path);

// The JSON form. Error for an environment whose image is not in the folder of `path`.
void save_lights(const Lights& lights, const std::filesystem::path& path);

}  // namespace chiaro::renderer
