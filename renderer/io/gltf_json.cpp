#include "renderer/io/gltf_json.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "renderer/core/error.h"
#include "renderer/io/gltf_json_rules.h"
#include "renderer/io/json_text.h"

namespace chiaro::renderer {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 256;

[[noreturn]] void fail(const std::string& file, const std::string& place, const std::string& problem,
                       const std::string& expected) {
  throw Error({file, place, problem, expected});
}

// Before it is parsed: a callback of the parser's, which could count as well, makes it look at all siblings of every
// object.
void check_depth(const std::string& text, const std::string& file) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') in_string = !in_string;
    if (c == '\\' && in_string) ++i;
    if (in_string) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMaxDepth) fail(file, "JSON", "is nested too deeply", fmt::format("at most {} levels", kMaxDepth));
  }
}

json parse(const std::string& text, const std::string& file) {
  check_depth(text, file);
  check_json_text(text, file);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    fail(file, "JSON", fmt::format("syntax error at byte {}", error.byte), "a glTF 2.0 scene");
  } catch (const json::exception&) {
    fail(file, "JSON", "holds a number that is out of range", "a glTF 2.0 scene");
  }
}

// One walk along a rule's path; the place is kept for messages.
class RuleCheck {
 public:
  RuleCheck(json& root, const JsonRule& rule, const std::string& file) : root_(root), rule_(rule), file_(file) {}

  void run() { walk(root_, rule_.path, ""); }

 private:
  void walk(json& value, std::string_view path, const std::string& place) {
    const std::size_t dot = path.find('.');
    const std::string_view key = path.substr(0, dot);
    const std::string_view rest = dot == std::string_view::npos ? std::string_view{} : path.substr(dot + 1);
    const bool last = rest.empty();
    if (key == "[]") {
      for (std::size_t i = 0; i < value.size(); ++i) step(value[i], rest, last, fmt::format("{}[{}]", place, i));
    } else if (key == "*") {
      for (auto& [name, member] : value.items()) step(member, rest, last, place + "." + name);
    } else {
      walk_member(value, key, rest, place);
    }
  }

  void walk_member(json& value, std::string_view key, std::string_view rest, const std::string& place) {
    const auto member = value.find(key);
    const std::string inner = place.empty() ? std::string(key) : fmt::format("{}.{}", place, key);
    if (member != value.end()) return step(*member, rest, rest.empty(), inner);
    if (!rest.empty() || !rule_.required) return;
    fail(file_, inner, "is missing", inner == "asset" ? "a glTF 2.0 scene" : kind());
  }

  void step(json& value, std::string_view rest, bool last, const std::string& place) {
    if (last) {
      check(value, place);
    } else {
      walk(value, rest, place);
    }
  }

  // What the rule wants, in words.
  std::string kind() const {
    switch (rule_.kind) {
      case JsonKind::kObject:
        return "an object";
      case JsonKind::kArray:
        return "an array";
      case JsonKind::kString:
        return "a string";
      case JsonKind::kBoolean:
        return "true or false";
      case JsonKind::kNumber:
        return "a number";
      case JsonKind::kNumbers:
        return fmt::format("an array of {} numbers", rule_.size);
      case JsonKind::kCount:
        return "a whole number, not negative";
      case JsonKind::kIndex:
        return fmt::format("an index into {}", rule_.target);
      case JsonKind::kIndices:
        return "an array of indices";
    }
    return "";
  }

  void check(json& value, const std::string& place) {
    switch (rule_.kind) {
      case JsonKind::kObject:
        return require(value.is_object(), place);
      case JsonKind::kArray:
        return require(value.is_array(), place);
      case JsonKind::kString:
        return require(value.is_string(), place);
      case JsonKind::kBoolean:
        return require(value.is_boolean(), place);
      case JsonKind::kNumber:
        return check_number(value, place);
      case JsonKind::kNumbers:
        return check_numbers(value, place);
      case JsonKind::kCount:
        return check_count(value, place);
      case JsonKind::kIndex:
        return check_index(value, place);
      case JsonKind::kIndices:
        return check_indices(value, place);
    }
  }

  void require(bool right, const std::string& place) const {
    if (!right) fail(file_, place, "is of the wrong type", kind());
  }

  // Whole numbers become others: those of extensions tinygltf would cut to 32 bits.
  void check_number(json& value, const std::string& place) const {
    if (!value.is_number()) fail(file_, place, "is of the wrong type", "a number");
    const double number = value.get<double>();
    value = number;
    if (number >= rule_.low && number <= rule_.high) return;
    fail(file_, place, fmt::format("is {}", number), fmt::format("{:g} to {:g}", rule_.low, rule_.high));
  }

  void check_numbers(json& value, const std::string& place) const {
    require(value.is_array() && int(value.size()) == rule_.size, place);
    for (json& element : value) check_number(element, place);
  }

  // Whole numbers written as 3.0 become 3.
  void check_count(json& value, const std::string& place) const {
    if (value.is_number_float() && value.get<double>() >= 0 && value.get<double>() < 9e15 &&
        std::floor(value.get<double>()) == value.get<double>()) {
      value = std::uint64_t(value.get<double>());
    }
    if (!value.is_number_unsigned()) fail(file_, place, "is of the wrong type", "a whole number, not negative");
    if (double(value.get<std::uint64_t>()) > rule_.high) {
      fail(file_, place, fmt::format("is {}", value.get<std::uint64_t>()), fmt::format("at most {:g}", rule_.high));
    }
  }

  std::size_t target_size() const {
    const json* array = &root_;
    for (std::string_view path = rule_.target; !path.empty();) {
      const std::size_t dot = path.find('.');
      const auto member = array->find(path.substr(0, dot));
      if (member == array->end()) return 0;
      array = &*member;
      path = dot == std::string_view::npos ? std::string_view{} : path.substr(dot + 1);
    }
    return array->is_array() ? array->size() : 0;
  }

  void check_index(json& value, const std::string& place) {
    check_count(value, place);
    if (!size_) size_ = target_size();
    if (value.get<std::uint64_t>() < *size_) return;
    fail(file_, place, fmt::format("{} is out of range", value.get<std::uint64_t>()),
         fmt::format("an index into {}, which has {}", rule_.target, *size_));
  }

  void check_indices(json& value, const std::string& place) {
    require(value.is_array(), place);
    for (std::size_t i = 0; i < value.size(); ++i) check_index(value[i], fmt::format("{}[{}]", place, i));
  }

  json& root_;
  const JsonRule& rule_;
  const std::string& file_;
  std::optional<std::size_t> size_;
};

void check_version(const json& root, const std::string& file) {
  const json& asset = root["asset"];
  const bool has_minimum = asset.contains("minVersion");
  const std::string version = (has_minimum ? asset["minVersion"] : asset["version"]).get<std::string>();
  const bool readable = has_minimum ? version == "2.0" : version.starts_with("2.");
  if (!readable) fail(file, "asset.version", fmt::format("is \"{}\"", version.substr(0, 20)), "2.0");
}

// What would be left out of nodes that have both.
void check_transforms(const json& root, const std::string& file) {
  const json none = json::array();
  const json& nodes = root.contains("nodes") ? root["nodes"] : none;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const char* const part : {"translation", "rotation", "scale"}) {
      if (!nodes[i].contains("matrix") || !nodes[i].contains(part)) continue;
      fail(file, fmt::format("nodes[{}]", i), fmt::format("has a matrix and a {}", part), "one or the other");
    }
  }
}

std::optional<std::string> string_member(const json& object, const char* key) {
  const auto member = object.find(key);
  return member == object.end() ? std::nullopt : std::optional(member->get<std::string>());
}

std::vector<GltfBufferSource> take_buffers(json& root) {
  std::vector<GltfBufferSource> buffers;
  for (const json& buffer : root.value("buffers", json::array())) {
    buffers.push_back({string_member(buffer, "uri"), buffer["byteLength"].get<std::size_t>()});
  }
  root.erase("buffers");
  return buffers;
}

std::vector<GltfImageSource> take_images(json& root) {
  std::vector<GltfImageSource> images;
  for (const json& image : root.value("images", json::array())) {
    images.push_back({image.value("name", ""), string_member(image, "uri"), image.value("bufferView", -1)});
  }
  root.erase("images");
  return images;
}

std::map<int, GltfMeshoptView> meshopt_views(const json& root) {
  std::map<int, GltfMeshoptView> views;
  const json none = json::array();
  const json& all = root.contains("bufferViews") ? root["bufferViews"] : none;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const json extensions = all[i].value("extensions", json::object());
    const auto found = extensions.find("EXT_meshopt_compression");
    if (found == extensions.end()) continue;
    const auto count = [&](const char* key) { return found->value(key, std::size_t{0}); };
    views[int(i)] = {found->value("buffer", 0),     count("byteOffset"), count("byteLength"),
                     count("byteStride"),           count("count"),      found->value("mode", ""),
                     found->value("filter", "NONE")};
  }
  return views;
}

std::vector<GltfSkin> take_skins(json& root) {
  std::vector<GltfSkin> skins;
  for (const json& skin : root.value("skins", json::array())) {
    skins.push_back({skin["joints"].get<std::vector<int>>(), skin.value("inverseBindMatrices", -1)});
  }
  root.erase("skins");
  return skins;
}

GltfAnimationChannel read_channel(const json& channel) {
  const json& target = channel["target"];
  return {channel["sampler"].get<int>(), target.value("node", -1), target["path"].get<std::string>()};
}

GltfAnimation read_animation(const json& source, const std::string& file, const std::string& place) {
  GltfAnimation animation;
  animation.name = source.value("name", "");
  for (const json& sampler : source["samplers"]) {
    animation.samplers.push_back(
        {sampler["input"].get<int>(), sampler["output"].get<int>(), sampler.value("interpolation", "LINEAR")});
  }
  for (const json& channel : source["channels"]) {
    animation.channels.push_back(read_channel(channel));
    const int sampler = animation.channels.back().sampler, count = int(animation.samplers.size());
    if (sampler < count) continue;
    fail(file, fmt::format("{}.channels[{}].sampler", place, animation.channels.size() - 1),
         fmt::format("{} is out of range", sampler), fmt::format("an index into samplers, which has {}", count));
  }
  return animation;
}

std::vector<GltfAnimation> take_animations(json& root, const std::string& file) {
  std::vector<GltfAnimation> animations;
  for (const json& animation : root.value("animations", json::array())) {
    animations.push_back(read_animation(animation, file, fmt::format("animations[{}]", animations.size())));
  }
  root.erase("animations");
  return animations;
}

void move_indices(json& root) {
  if (!root.contains("meshes")) return;
  for (json& mesh : root["meshes"]) {
    for (json& primitive : mesh["primitives"]) {
      if (primitive.contains("indices")) primitive["attributes"][kIndicesAttribute] = primitive["indices"];
      primitive.erase("indices");
    }
  }
}

}  // namespace

GltfJson check_gltf_json(const std::string& text, const std::filesystem::path& path) {
  const std::string file = path.string();
  json root = parse(text, file);
  if (!root.is_object()) fail(file, "JSON", "is not an object", "a glTF 2.0 scene");
  for (const JsonRule& rule : gltf_json_rules()) RuleCheck(root, rule, file).run();
  check_version(root, file);
  check_transforms(root, file);
  GltfJson result;
  result.animations = take_animations(root, file);
  result.skins = take_skins(root);
  move_indices(root);
  result.extensions_used = root.value("extensionsUsed", std::vector<std::string>{});
  result.extensions_required = root.value("extensionsRequired", std::vector<std::string>{});
  result.buffers = take_buffers(root);
  result.images = take_images(root);
  result.meshopt_views = meshopt_views(root);
  result.structure = root.dump();
  result.size = text.size();
  return result;
}

}  // namespace chiaro::renderer
