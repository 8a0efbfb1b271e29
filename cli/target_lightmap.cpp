#include "cli/target_lightmap.h"

#include <fmt/format.h>

#include "cli/text_output.h"
#include "renderer/core/counted.h"
#include "renderer/core/error.h"

namespace chiaro::cli {
namespace {

using inverse::LightmapValues;

void require_some_used(const LightmapFile& lightmap, const LightmapValues& read) {
  if (read.counts.used > 0 && !(read.area > 0)) {
    throw renderer::Error({lightmap.file, "", fmt::format("'{}' has no area in the scene", lightmap.node),
                           "a node that is not scaled to nothing"});
  }
  if (read.counts.used > 0) return;
  throw renderer::Error(
      {lightmap.file, "",
       fmt::format("no texel tells an illumination of '{}' by its TEXCOORD_{} ({} in no triangle, {} in several, {} "
                   "masked, {} not finite or negative; {} triangles leave the picture)",
                   lightmap.node, read.uv_set, read.counts.empty, read.counts.overlapping, read.counts.masked,
                   read.counts.invalid, read.triangles_outside),
       "a layout from 0 to 1 in which no triangles overlap"});
}

void warn_of_lightmap(const LightmapFile& lightmap, const LightmapValues& read, Session& session) {
  const auto warn = [&](std::size_t count, const char* one, const char* many, const std::string& what) {
    if (count > 0) session.warn(fmt::format("{}: {} {}", lightmap.file, renderer::counted(count, one, many), what));
  };
  warn(read.counts.invalid, "texel is", "texels are", "not finite or negative, and left out");
  warn(read.counts.overlapping, "texel is", "texels are",
       fmt::format("in several triangles of '{}' at once, and left out: its TEXCOORD_{} overlaps itself", lightmap.node,
                   read.uv_set));
  warn(read.triangles_outside, "triangle is", "triangles are",
       fmt::format("left out of '{}': TEXCOORD_{} leaves the range from 0 to 1 there, and lightmaps do not repeat",
                   lightmap.node, read.uv_set));
  if (read.copies > 1) {
    session.warn(fmt::format("{}: '{}' stands in the scene {} times: the lightmap is taken to show each of them",
                             lightmap.file, lightmap.node, read.copies));
  }
}

JsonObject lightmap_summary(const LightmapFile& lightmap, const PaintedPicture& picture, const LightmapValues& read) {
  return {{"node", lightmap.node},
          {"file", lightmap.file},
          {"encoding", picture.encoding},
          {"white", picture.white},
          {"uv_set", read.uv_set},
          {"texels", picture.pixels.size()},
          {"used", read.counts.used},
          {"empty", read.counts.empty},
          {"overlapping", read.counts.overlapping},
          {"masked", read.counts.masked},
          {"white_texels", picture.white_pixels},
          {"invalid", read.counts.invalid},
          {"triangles_outside", read.triangles_outside},
          {"copies", read.copies},
          {"area", read.area}};
}

std::string lightmap_text(const LightmapFile& lightmap, const PaintedPicture& picture, const LightmapValues& read) {
  return aligned_rows(
      {{fmt::format("{} on {}", lightmap.file, lightmap.node),
        fmt::format("{}, white is {} cd/m², TEXCOORD_{}, {} of {} texels used on {:.3g} m²", picture.encoding,
                    text_of_vector(picture.white), read.uv_set, read.counts.used, picture.pixels.size(), read.area)}});
}

}  // namespace

TargetLightmap load_target_lightmap(const renderer::Scene& scene, const LightmapFile& lightmap,
                                    const PictureEncoding& encoding, Session& session) {
  PaintedPicture picture = load_painted_picture(lightmap.file, encoding);
  TargetLightmap loaded;
  loaded.values = inverse::values_of_lightmap(
      scene, {lightmap.node, lightmap.uv_set, picture.width, picture.height, picture.pixels, picture.weight});
  require_some_used(lightmap, loaded.values);
  warn_of_lightmap(lightmap, loaded.values, session);
  loaded.summary = lightmap_summary(lightmap, picture, loaded.values);
  loaded.text = lightmap_text(lightmap, picture, loaded.values);
  return loaded;
}

}  // namespace chiaro::cli
