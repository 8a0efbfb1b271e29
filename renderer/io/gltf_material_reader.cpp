#include "renderer/io/gltf_material_reader.h"

#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace chiaro::renderer {
namespace {

Vec2f pair_member(const tinygltf::Value& object, const std::string& name, Vec2f absent) {
  if (!object.Has(name)) return absent;
  const tinygltf::Value& pair = object.Get(name);
  return {float(pair.Get(0).GetNumberAsDouble()), float(pair.Get(1).GetNumberAsDouble())};
}

void read_transform(const tinygltf::Value& source, TextureUse& use) {
  const Vec2f offset = pair_member(source, "offset", {0, 0}), scale = pair_member(source, "scale", {1, 1});
  const auto rotation = float(number_member(source, "rotation", 0));
  use.uv_set = int(number_member(source, "texCoord", use.uv_set));
  use.transformed = offset.x != 0 || offset.y != 0 || rotation != 0 || scale.x != 1 || scale.y != 1;
  if (use.transformed) use.transform = make_uv_transform(offset, rotation, scale);
}

}  // namespace

float unit_factor(GltfMaterialReader& reader, const std::string& name, double value) {
  if (!(value >= 0 && value <= 1)) {
    reader.warnings.push_back(fmt::format("{}.{}: {} is clamped to 0..1", reader.place, name, value));
  }
  return float(std::clamp(value, 0.0, 1.0));
}

TextureUse texture_use(GltfMaterialReader& reader, const std::string& name, const GltfTextureInfo& info) {
  if (info.index < 0) return {};
  const std::string place = fmt::format("{}.{}", reader.place, name);
  TextureUse use;
  use.texture = reader.textures.add(reader.document, info.index, place, reader.warnings);
  use.uv_set = info.uv_set;
  if (info.transform != nullptr) read_transform(*info.transform, use);
  if (use.uv_set >= kUvSetCount) {
    reader.warnings.push_back(fmt::format("{}: TEXCOORD_{} is not read; TEXCOORD_0 is used", place, use.uv_set));
    use.uv_set = 0;
  }
  return use;
}

TextureUse texture_member(GltfMaterialReader& reader, const tinygltf::Value& extension, const std::string& name) {
  if (!extension.Has(name)) return {};
  const tinygltf::Value& source = extension.Get(name);
  GltfTextureInfo info{.index = source.Get("index").GetNumberAsInt(),
                       .uv_set = int(number_member(source, "texCoord", 0))};
  if (source.Has("extensions") && source.Get("extensions").Has("KHR_texture_transform")) {
    info.transform = &source.Get("extensions").Get("KHR_texture_transform");
  }
  return texture_use(reader, name, info);
}

double number_member(const tinygltf::Value& extension, const std::string& name, double absent) {
  return extension.Has(name) ? extension.Get(name).GetNumberAsDouble() : absent;
}

Vec3f color_member(const tinygltf::Value& extension, const std::string& name, Vec3f absent) {
  if (!extension.Has(name)) return absent;
  const tinygltf::Value& color = extension.Get(name);
  const auto channel = [&](int i) { return float(color.Get(i).GetNumberAsDouble()); };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace chiaro::renderer
