#include "cli/frame_metadata.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/common_options.h"
#include "cli/text_output.h"

namespace chiaro::cli {
namespace {

using renderer::Mat4f;

// The camera looks along −z. glTF 2.0 specification, 3.10.3: finite and infinite perspective projection.
Mat4f perspective(const renderer::Camera& camera, double aspect) {
  Mat4f p;
  const double cotangent = 1 / std::tan(0.5 * camera.vertical_fov);
  const bool infinite = !std::isfinite(camera.far);
  const double near = camera.near, far = camera.far;
  p(0, 0) = float(cotangent / aspect);
  p(1, 1) = float(cotangent);
  p(2, 2) = infinite ? -1.0F : float((far + near) / (near - far));
  p(2, 3) = float(infinite ? -2 * near : 2 * far * near / (near - far));
  p(3, 2) = -1;
  p(3, 3) = 0;
  return p;
}

// glTF 2.0 specification, 3.10.3.4, with the width that the frame's shape gives.
Mat4f orthographic(const renderer::Camera& camera, double aspect) {
  Mat4f p;
  const double near = camera.near, far = camera.far;
  p(0, 0) = float(1 / (camera.half_height * aspect));
  p(1, 1) = 1 / camera.half_height;
  if (std::isfinite(far) && far != near) {
    p(2, 2) = float(2 / (near - far));
    p(2, 3) = float((far + near) / (near - far));
  }
  return p;
}

Mat4f diagonal(float x, float y, float z) {
  Mat4f matrix;
  matrix(0, 0) = x, matrix(1, 1) = y, matrix(2, 2) = z;
  return matrix;
}

// From the cube of glTF, −1 … 1 and y up, to OpenEXR's coordinates: (0, 0) is the frame's upper left corner and (1, 1)
// its lower right one.
Mat4f ndc_from_clip() {
  Mat4f matrix = diagonal(0.5F, -0.5F, 1);
  matrix(0, 3) = matrix(1, 3) = 0.5F;
  return matrix;
}

// A scale above a camera does not change its picture.
Mat4f without_scale(Mat4f matrix) {
  for (int column = 0; column < 3; ++column) {
    const renderer::Vec3f axis = renderer::normalize(matrix.column(column));
    for (int row = 0; row < 3; ++row) matrix(row, column) = axis[row];
  }
  return matrix;
}

void add_environment(renderer::Attributes& attributes, const renderer::EnvironmentLight& environment) {
  const std::string image = std::filesystem::path(environment.image).filename().string();
  if (!image.empty()) attributes.emplace_back("chiaro:environment", image);
  attributes.emplace_back("chiaro:environment_rotation", float(degrees_of(environment.rotation)));
  attributes.emplace_back("chiaro:environment_intensity", environment.intensity);
}

// What not every frame has.
void add_choices(renderer::Attributes& attributes, const FrameOrigin& origin) {
  if (origin.hide_backs) attributes.emplace_back("chiaro:hide_backs", 1);
  if (!origin.light_file.empty()) attributes.emplace_back("chiaro:lights", origin.light_file);
  if (!origin.variant.empty()) attributes.emplace_back("chiaro:variant", origin.variant);
  const auto& [animation, seconds] = origin.animation;
  if (!animation.empty()) attributes.emplace_back("chiaro:animation", animation);
  if (seconds) attributes.emplace_back("chiaro:animation_time", float(*seconds));
  if (origin.environment) add_environment(attributes, *origin.environment);
}

}  // namespace

Mat4f ndc_from_camera(const renderer::Camera& camera, double frame_aspect_ratio) {
  return ndc_from_clip() *
         (camera.orthographic ? orthographic(camera, frame_aspect_ratio) : perspective(camera, frame_aspect_ratio));
}

std::array<float, 16> row_vector_matrix(const Mat4f& matrix) {
  // Column-major storage of a matrix is row-major storage of its transpose.
  return matrix.m;
}

renderer::Attributes frame_attributes(const renderer::Camera& camera, double frame_aspect_ratio,
                                      const FrameOrigin& origin) {
  const Mat4f camera_from_world = renderer::inverse_affine(without_scale(camera.world_from_camera));
  const Mat4f ndc_from_world = ndc_from_camera(camera, frame_aspect_ratio) * camera_from_world;
  renderer::Attributes attributes{
      {"whiteLuminance", 1.0F},
      {"worldToCamera", row_vector_matrix(diagonal(1, 1, -1) * camera_from_world)},  // OpenEXR's looks along +z
      {"worldToNDC", row_vector_matrix(ndc_from_world)},
      {"chiaro:version", program_version()},
      {"chiaro:units", std::string("cd/m^2")},
      {"chiaro:scene", origin.scene},
      {"chiaro:camera", camera.name},
      {"chiaro:materials", origin.materials},
      {"chiaro:bounces", origin.bounces},
      {"chiaro:seed", fmt::format("{}", origin.seed)},
  };
  if (!camera.orthographic) {
    const double width = 2 * std::tan(0.5 * camera.vertical_fov) * frame_aspect_ratio;  // a metre away
    attributes.emplace_back("screenWindowWidth", float(width));
  }
  add_choices(attributes, origin);
  return attributes;
}

void add_matte_attributes(renderer::Attributes& attributes, const std::vector<renderer::Matte>& mattes) {
  for (const renderer::Matte& matte : mattes) {
    nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
    for (const auto& [name, id] : matte.manifest) manifest[name] = fmt::format("{:08x}", id);
    const std::string key =
        "cryptomatte/" + fmt::format("{:08x}", renderer::murmur_hash_3_32(matte.layer)).substr(0, 7);
    attributes.emplace_back(key + "/name", matte.layer);
    attributes.emplace_back(key + "/hash", std::string("MurmurHash3_32"));
    attributes.emplace_back(key + "/conversion", std::string("uint32_to_float32"));
    // Names are as the scene has them, and bytes that are no UTF-8 cannot stand in JSON.
    attributes.emplace_back(key + "/manifest",
                            manifest.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
}

}  // namespace chiaro::cli
