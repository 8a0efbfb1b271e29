#pragma once

#include <optional>
#include <string>

#include "cli/json_output.h"
#include "cli/painted_picture.h"
#include "cli/session.h"
#include "inverse/target/lightmap.h"

namespace chiaro::cli {

struct LightmapFile {
  std::string node, file;
  std::optional<int> uv_set;
};

struct TargetLightmap {
  inverse::LightmapValues values;
  JsonObject summary;
  std::string text;  // the same for people
};

// The illumination that the file shows on the node; what is odd about it is warned of. Error where no texel tells any.
TargetLightmap load_target_lightmap(const renderer::Scene& scene, const LightmapFile& lightmap,
                                    const PictureEncoding& encoding, Session& session);

}  // namespace chiaro::cli
