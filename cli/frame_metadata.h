#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "renderer/image/image_file.h"
#include "renderer/io/gltf_animation.h"
#include "renderer/scene/light.h"
#include "renderer/scene/scene.h"
#include "renderer/trace/cryptomatte.h"

namespace chiaro::cli {

// What a frame's header says besides the camera. No date and no duration: the same frame has the same bytes. Files are
// names without folders.
struct FrameOrigin {
  std::string scene;
  std::string materials;
  std::uint64_t seed = 0;
  int bounces = -1;
  bool hide_backs = false;
  std::string light_file = {};  // empty: the lights are the scene's
  std::string variant = {};     // empty: none
  renderer::AnimationChoice animation = {};
  std::optional<renderer::EnvironmentLight> environment = {};
};

// CIE xy of Rec.709's red, green, blue and D65.
inline constexpr std::array<float, 8> kRec709Chromaticities{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};

// Projection of glTF's camera space (looking along -Z) to OpenEXR's normalized device coordinates: x from 0 to 1 to the
// right, y from 0 to 1 down the frame, z from -1 to 1 as glTF defines it.
renderer::Mat4f ndc_from_camera(const renderer::Camera& camera, double frame_aspect_ratio);

// In OpenEXR's row-vector convention: the transpose of a column-vector matrix.
std::array<float, 16> row_vector_matrix(const renderer::Mat4f& matrix);

// worldToCamera and worldToNDC as OpenEXR defines them, screenWindowWidth, whiteLuminance, and ours under "chiaro:".
// Chromaticities are the caller's.
renderer::Attributes frame_attributes(const renderer::Camera& camera, double frame_aspect_ratio,
                                      const FrameOrigin& origin);

// Name, hash, conversion and manifest of each matte layer, under the keys of the Cryptomatte specification.
void add_matte_attributes(renderer::Attributes& attributes, const std::vector<renderer::Matte>& mattes);

}  // namespace chiaro::cli
