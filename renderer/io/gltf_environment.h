#pragma once
// EXT_lights_image_based: the environment of a scene.

#include <optional>
#include <vector>

#include "renderer/io/gltf_document.h"
#include "renderer/scene/light.h"

namespace chiaro::renderer {

// The image-based light of the scene that is shown. Its radiance is that of the cube map's first, sharpest level, sRGB
// colours divided by alpha as the extension packs them, times its intensity; what the extension adds for rasterizers
// (blurred levels, irradiance coefficients) follows from it and is not read. Needs the document's buffers. Error, naming
// the image, for faces that are missing, not square or not of one size.
std::optional<EnvironmentLight> read_environment(const GltfDocument& document, std::vector<std::string>& warnings);

// Whether there is one.
bool has_environment(const GltfDocument& document);

}  // namespace chiaro::renderer
