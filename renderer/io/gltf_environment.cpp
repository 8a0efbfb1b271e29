#include "renderer/io/gltf_environment.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "renderer/core/control.h"
#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"
#include "renderer/image/image_file.h"
#include "renderer/image/texel_encoding.h"

namespace chiaro::renderer {
namespace {

constexpr const char* kExtension = "EXT_lights_image_based";
constexpr int kMostFace = 4096;  // pixels a side: a map of 16384 x 8192

// +X, -X, +Y, -Y, +Z, -Z, each as it is seen from within.
struct CubeMap {
  int size = 0;
  std::array<std::vector<Vec3f>, 6> faces;
};

std::optional<int> light_of(const tinygltf::Scene& scene) {
  const auto extension = scene.extensions.find(kExtension);
  if (extension == scene.extensions.end() || !extension->second.Has("light")) return std::nullopt;
  return extension->second.Get("light").GetNumberAsInt();
}

std::optional<int> light_of(const GltfDocument& document) {
  const tinygltf::Scene* const scene = shown_scene(document);
  return scene != nullptr ? light_of(*scene) : std::nullopt;
}

Texture decode(const GltfDocument& document, int image) {
  const std::string label = fmt::format("images[{}]", image);
  try {
    return decode_texture(image_bytes(document, image), label);
  } catch (const Error& error) {
    if (error.parts().file != label) throw;
    fail(document, label, error.parts().problem, error.parts().expected);
  }
}

// RGBD: linear colours divided by alpha; without alpha nothing is divided.
template <class Channel>
std::vector<Vec3f> radiance_of(const std::vector<Channel>& rgba) {
  constexpr float kOpaque = std::numeric_limits<Channel>::max();
  const DecodeTableOf<Channel>& linear = decode_table<Channel>(true);
  std::vector<Vec3f> pixels(rgba.size() / 4);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Channel* p = &rgba[4 * i];
    pixels[i] = Vec3f{linear[p[0]], linear[p[1]], linear[p[2]]} / (float(std::max<int>(p[3], 1)) / kOpaque);
  }
  return pixels;
}

std::vector<Vec3f> radiance_of(const Texture& texture) {
  return is_wide(texture) ? radiance_of(texture.wide_rgba) : radiance_of(texture.rgba);
}

CubeMap read_cube_map(const GltfDocument& document, const tinygltf::Value& light, const std::string& place) {
  const tinygltf::Value& levels = light.Get("specularImages");
  if (levels.ArrayLen() == 0 || levels.Get(0).ArrayLen() != 6) {
    fail(document, place + ".specularImages", "has no level of six faces", "levels of six images each");
  }
  CubeMap cube;
  for (std::size_t face = 0; face < 6; ++face) {
    const int image = levels.Get(0).Get(face).GetNumberAsInt();
    const Texture texture = decode(document, image);
    if (texture.width != texture.height || (cube.size > 0 && texture.width != cube.size)) {
      fail(document, fmt::format("images[{}]", image), fmt::format("{} x {} pixels", texture.width, texture.height),
           "a square as large as the other faces of the cube");
    }
    if (texture.width > kMostFace) {
      fail(document, fmt::format("images[{}]", image), fmt::format("{} x {} pixels", texture.width, texture.height),
           fmt::format("at most {0} x {0}", kMostFace));
    }
    cube.size = texture.width;
    cube.faces[face] = radiance_of(texture);
  }
  return cube;
}

struct FacePoint {
  std::size_t face;
  float s, t;  // -1 to 1, to the right and down
};

// The faces of OpenGL's cube maps (specification 4.6, table 8.19), mirrored left to right as the extension wants them.
FacePoint face_point(Vec3f d) {
  const Vec3f a = abs(d);
  if (a.x >= a.y && a.x >= a.z)
    return d.x > 0 ? FacePoint{0, d.z / a.x, -d.y / a.x} : FacePoint{1, -d.z / a.x, -d.y / a.x};
  if (a.y >= a.z) return d.y > 0 ? FacePoint{2, -d.x / a.y, d.z / a.y} : FacePoint{3, -d.x / a.y, -d.z / a.y};
  return d.z > 0 ? FacePoint{4, -d.x / a.z, -d.y / a.z} : FacePoint{5, d.x / a.z, -d.y / a.z};
}

// Bilinear within a face.
Vec3f look_up(const CubeMap& cube, Vec3f direction) {
  const FacePoint p = face_point(direction);
  const auto last = float(cube.size - 1);
  const float x = std::clamp((p.s + 1) / 2 * float(cube.size) - 0.5F, 0.0F, last);
  const float y = std::clamp((p.t + 1) / 2 * float(cube.size) - 0.5F, 0.0F, last);
  const int column = std::min(int(x), std::max(0, cube.size - 2)), row = std::min(int(y), std::max(0, cube.size - 2));
  const int right = std::min(column + 1, cube.size - 1), below = std::min(row + 1, cube.size - 1);
  const auto at = [&](int i, int j) {
    return cube.faces[p.face][std::size_t(j) * std::size_t(cube.size) + std::size_t(i)];
  };
  return lerp(y - float(row), lerp(x - float(column), at(column, row), at(right, row)),
              lerp(x - float(column), at(column, below), at(right, below)));
}

// As fine as the faces, each pixel the mean of four points.
EnvironmentMap latlong_map(const CubeMap& cube, const Mat4f& map_from_world) {
  EnvironmentMap map{4 * cube.size, 2 * cube.size, {}};
  map.pixels.resize(std::size_t(map.width) * std::size_t(map.height));
  parallel_for(std::size_t(map.height), [&](std::size_t row) {
    for (std::size_t column = 0; column < std::size_t(map.width); ++column) {
      Vec3f sum;
      for (const auto& [dx, dy] : {std::pair{0.25F, 0.25F}, {0.75F, 0.25F}, {0.25F, 0.75F}, {0.75F, 0.75F}}) {
        const Vec2f uv{(float(column) + dx) / float(map.width), (float(row) + dy) / float(map.height)};
        sum += look_up(cube, transform_direction(map_from_world, direction_of_latlong(uv)));
      }
      map.pixels[row * std::size_t(map.width) + column] = sum / 4;
    }
  });
  return map;
}

// From the extension's quaternion.
Mat4f rotation_of(const GltfDocument& document, const tinygltf::Value& light, const std::string& place) {
  if (!light.Has("rotation")) return {};
  double q[4], squared = 0;
  for (int i = 0; i < 4; ++i) {
    q[i] = light.Get("rotation").Get(i).GetNumberAsDouble();
    squared += q[i] * q[i];
  }
  if (!(squared > 1e-12) || !std::isfinite(squared))
    fail(document, place + ".rotation", "is no rotation", "a unit quaternion");
  const double l = std::sqrt(squared);
  return make_transform({}, {float(q[0] / l), float(q[1] / l), float(q[2] / l), float(q[3] / l)}, {1, 1, 1});
}

float intensity_of(const GltfDocument& document, const tinygltf::Value& light, const CubeMap& cube,
                   const std::string& place) {
  const double intensity = light.Has("intensity") ? light.Get("intensity").GetNumberAsDouble() : 1;
  double brightest = 1;
  for (const std::vector<Vec3f>& face : cube.faces) {
    for (const Vec3f pixel : face) brightest = std::max(brightest, double(max_component(pixel)));
  }
  if (intensity * brightest > double(kBrightest)) {
    fail(document, place + ".intensity", "is too bright", fmt::format("at most {:g} cd/m²", kBrightest));
  }
  return float(intensity);
}

std::string name_of(const tinygltf::Value& light) {
  const std::string name =
      light.Has("name") && light.Get("name").IsString() ? light.Get("name").Get<std::string>() : "";
  return name.empty() ? "environment" : name;
}

}  // namespace

bool has_environment(const GltfDocument& document) { return light_of(document).has_value(); }

std::optional<EnvironmentLight> read_environment(const GltfDocument& document, std::vector<std::string>& warnings) {
  const std::optional<int> index = light_of(document);
  if (!index) return std::nullopt;
  const std::string place = fmt::format("extensions.{}.lights[{}]", kExtension, *index);
  const tinygltf::Value& source = document.model->extensions.at(kExtension).Get("lights").Get(*index);
  const CubeMap cube = read_cube_map(document, source, place);
  EnvironmentLight light;
  light.name = name_of(source);
  light.intensity = intensity_of(document, source, cube, place);
  light.map =
      std::make_shared<const EnvironmentMap>(latlong_map(cube, inverse_affine(rotation_of(document, source, place))));
  if (!(light.intensity > 0)) {
    warnings.push_back(fmt::format("{}: has no intensity; left out", place));
    return std::nullopt;
  }
  return light;
}

}  // namespace chiaro::renderer
