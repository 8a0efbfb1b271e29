#include "renderer/io/gltf_json_rules.h"

namespace chiaro::renderer {
namespace {

using enum JsonKind;

constexpr double kLargest = 3.4e38;
constexpr bool kRequired = true, kOptional = false;

constexpr JsonRule index(std::string_view path, std::string_view target, bool required = false) {
  return {path, kIndex, required, target};
}
constexpr JsonRule number(std::string_view path, double low = -kLargest, double high = kLargest,
                          bool required = false) {
  return {path, kNumber, required, {}, 0, low, high};
}
constexpr JsonRule numbers(std::string_view path, int size, double low = -kLargest, double high = kLargest) {
  return {path, kNumbers, kOptional, {}, size, low, high};
}
constexpr std::string_view kLightArray = "extensions.KHR_lights_punctual.lights";

constexpr std::string_view kEnvironmentArray = "extensions.EXT_lights_image_based.lights";

constexpr JsonRule kRules[] = {
    {"asset", kObject, kRequired},
    {"asset.version", kString, kRequired},
    {"asset.minVersion", kString},
    {"extensions", kObject},
    {"extensionsUsed", kArray},
    {"extensionsUsed.[]", kString},
    {"extensionsRequired", kArray},
    {"extensionsRequired.[]", kString},

    {"buffers", kArray},
    {"buffers.[]", kObject},
    {"buffers.[].byteLength", kCount, kRequired},
    {"buffers.[].uri", kString},
    {"bufferViews", kArray},
    {"bufferViews.[]", kObject},
    index("bufferViews.[].buffer", "buffers", kRequired),
    {"bufferViews.[].byteOffset", kCount},
    {"bufferViews.[].byteLength", kCount, kRequired},
    {"bufferViews.[].byteStride", kCount},

    {"accessors", kArray},
    {"accessors.[]", kObject},
    index("accessors.[].bufferView", "bufferViews"),
    {"accessors.[].byteOffset", kCount},
    {"accessors.[].componentType", kCount, kRequired},
    {"accessors.[].count", kCount, kRequired},
    {"accessors.[].type", kString, kRequired},
    {"accessors.[].normalized", kBoolean},
    {"accessors.[].sparse", kObject},
    {"accessors.[].sparse.count", kCount, kRequired},
    {"accessors.[].sparse.indices", kObject, kRequired},
    index("accessors.[].sparse.indices.bufferView", "bufferViews", kRequired),
    {"accessors.[].sparse.indices.byteOffset", kCount},
    {"accessors.[].sparse.indices.componentType", kCount, kRequired},
    {"accessors.[].sparse.values", kObject, kRequired},
    index("accessors.[].sparse.values.bufferView", "bufferViews", kRequired),
    {"accessors.[].sparse.values.byteOffset", kCount},

    {"meshes", kArray},
    {"meshes.[]", kObject},
    {"meshes.[].name", kString},
    {"meshes.[].primitives", kArray, kRequired},
    {"meshes.[].primitives.[]", kObject},
    {"meshes.[].primitives.[].attributes", kObject, kRequired},
    index("meshes.[].primitives.[].attributes.*", "accessors"),
    index("meshes.[].primitives.[].indices", "accessors"),
    index("meshes.[].primitives.[].material", "materials"),
    {"meshes.[].primitives.[].mode", kCount, kOptional, {}, 0, 0, 6},
    {"meshes.[].primitives.[].targets", kArray},

    {"images", kArray},
    {"images.[]", kObject},
    {"images.[].name", kString},
    {"images.[].uri", kString},
    index("images.[].bufferView", "bufferViews"),
    {"samplers", kArray},
    {"samplers.[]", kObject},
    {"samplers.[].magFilter", kCount},
    {"samplers.[].minFilter", kCount},
    {"samplers.[].wrapS", kCount},
    {"samplers.[].wrapT", kCount},
    {"textures", kArray},
    {"textures.[]", kObject},
    index("textures.[].source", "images"),
    index("textures.[].sampler", "samplers"),
    {"textures.[].extensions", kObject},
    {"textures.[].extensions.EXT_texture_webp", kObject},
    index("textures.[].extensions.EXT_texture_webp.source", "images", kRequired),

    {"materials", kArray},
    {"materials.[]", kObject},
    {"materials.[].name", kString},
    {"materials.[].alphaMode", kString},
    number("materials.[].alphaCutoff", 0),
    {"materials.[].doubleSided", kBoolean},
    numbers("materials.[].emissiveFactor", 3, 0),
    {"materials.[].emissiveTexture", kObject},
    index("materials.[].emissiveTexture.index", "textures", kRequired),
    {"materials.[].emissiveTexture.texCoord", kCount},
    {"materials.[].normalTexture", kObject},
    index("materials.[].normalTexture.index", "textures", kRequired),
    {"materials.[].normalTexture.texCoord", kCount},
    number("materials.[].normalTexture.scale"),
    {"materials.[].occlusionTexture", kObject},
    index("materials.[].occlusionTexture.index", "textures", kRequired),
    {"materials.[].occlusionTexture.texCoord", kCount},
    {"materials.[].pbrMetallicRoughness", kObject},
    numbers("materials.[].pbrMetallicRoughness.baseColorFactor", 4),
    {"materials.[].pbrMetallicRoughness.baseColorTexture", kObject},
    index("materials.[].pbrMetallicRoughness.baseColorTexture.index", "textures", kRequired),
    {"materials.[].pbrMetallicRoughness.baseColorTexture.texCoord", kCount},
    number("materials.[].pbrMetallicRoughness.metallicFactor"),
    number("materials.[].pbrMetallicRoughness.roughnessFactor"),
    {"materials.[].pbrMetallicRoughness.metallicRoughnessTexture", kObject},
    index("materials.[].pbrMetallicRoughness.metallicRoughnessTexture.index", "textures", kRequired),
    {"materials.[].pbrMetallicRoughness.metallicRoughnessTexture.texCoord", kCount},
    {"materials.[].extensions", kObject},
    {"materials.[].extensions.KHR_materials_emissive_strength", kObject},
    number("materials.[].extensions.KHR_materials_emissive_strength.emissiveStrength", 0),

    {"cameras", kArray},
    {"cameras.[]", kObject},
    {"cameras.[].name", kString},
    {"cameras.[].type", kString, kRequired},
    {"cameras.[].perspective", kObject},
    number("cameras.[].perspective.yfov", 1e-6, 3.1415926, kRequired),
    number("cameras.[].perspective.znear", 0, kLargest, kRequired),
    number("cameras.[].perspective.zfar", 0),
    number("cameras.[].perspective.aspectRatio", 1e-6, 1e6),
    {"cameras.[].orthographic", kObject},
    number("cameras.[].orthographic.xmag", -kLargest, kLargest, kRequired),
    number("cameras.[].orthographic.ymag", -kLargest, kLargest, kRequired),
    number("cameras.[].orthographic.znear", 0, kLargest, kRequired),
    number("cameras.[].orthographic.zfar", 0, kLargest, kRequired),

    {"extensions.KHR_lights_punctual", kObject},
    {kLightArray, kArray, kRequired},
    {"extensions.KHR_lights_punctual.lights.[]", kObject},
    {"extensions.KHR_lights_punctual.lights.[].name", kString},
    {"extensions.KHR_lights_punctual.lights.[].type", kString, kRequired},
    numbers("extensions.KHR_lights_punctual.lights.[].color", 3, 0),
    number("extensions.KHR_lights_punctual.lights.[].intensity", 0),
    number("extensions.KHR_lights_punctual.lights.[].range", 0),
    {"extensions.KHR_lights_punctual.lights.[].spot", kObject},
    number("extensions.KHR_lights_punctual.lights.[].spot.innerConeAngle", 0, 1.5707964),
    number("extensions.KHR_lights_punctual.lights.[].spot.outerConeAngle", 0, 1.5707964),

    {"extensions.EXT_lights_image_based", kObject},
    {kEnvironmentArray, kArray, kRequired},
    {"extensions.EXT_lights_image_based.lights.[]", kObject},
    {"extensions.EXT_lights_image_based.lights.[].name", kString},
    numbers("extensions.EXT_lights_image_based.lights.[].rotation", 4),
    number("extensions.EXT_lights_image_based.lights.[].intensity", 0),
    {"extensions.EXT_lights_image_based.lights.[].specularImages", kArray, kRequired},
    {"extensions.EXT_lights_image_based.lights.[].specularImages.[]", kIndices, kOptional, "images"},

    {"nodes", kArray},
    {"nodes.[]", kObject},
    {"nodes.[].name", kString},
    {"nodes.[].children", kIndices, kOptional, "nodes"},
    index("nodes.[].mesh", "meshes"),
    index("nodes.[].camera", "cameras"),
    numbers("nodes.[].matrix", 16),
    numbers("nodes.[].translation", 3),
    numbers("nodes.[].rotation", 4),
    numbers("nodes.[].scale", 3),
    {"nodes.[].extensions", kObject},
    {"nodes.[].extensions.KHR_lights_punctual", kObject},
    index("nodes.[].extensions.KHR_lights_punctual.light", kLightArray, kRequired),
    {"nodes.[].extensions.EXT_mesh_gpu_instancing", kObject},
    {"nodes.[].extensions.EXT_mesh_gpu_instancing.attributes", kObject, kRequired},
    index("nodes.[].extensions.EXT_mesh_gpu_instancing.attributes.*", "accessors"),

    {"scenes", kArray},
    {"scenes.[]", kObject},
    {"scenes.[].nodes", kIndices, kOptional, "nodes"},
    {"scenes.[].extensions", kObject},
    {"scenes.[].extensions.EXT_lights_image_based", kObject},
    index("scenes.[].extensions.EXT_lights_image_based.light", kEnvironmentArray, kRequired),
    index("scene", "scenes"),
};

}  // namespace

std::span<const JsonRule> gltf_json_rules() { return kRules; }

}  // namespace chiaro::renderer
