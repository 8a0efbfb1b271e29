#pragma once
// Environments: pictures of the light from all around.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/light.h"

namespace chiaro::renderer {

// A latitude-longitude image (.exr, .hdr, or any that OpenImageIO reads) as a light named "environment", in
// scene-linear Rec.709; `config` as scene_linear_rec709 takes it. Pixels that are no light are mended, with a warning:
// what is not a number or negative becomes 0, what is infinite the largest half. Error for what is not such an image,
// and for one without light.
EnvironmentLight load_environment(const std::filesystem::path& path, std::vector<std::string>& warnings,
                                  const std::optional<std::filesystem::path>& config = std::nullopt);

// Makes all pixels finite and not negative. Returns how many were not.
std::size_t mend_pixels(EnvironmentMap& map);

}  // namespace chiaro::renderer
