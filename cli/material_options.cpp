#include "cli/material_options.h"

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/usage_error.h"

namespace chiaro::cli {
namespace {

renderer::MaterialModel parse_model(const std::string& text) {
  if (text == "diffuse") return renderer::MaterialModel::kDiffuse;
  if (text == "gltf") return renderer::MaterialModel::kGltf;
  throw UsageError(fmt::format("'{}' (expected gltf or diffuse)", text));
}

}  // namespace

void add_material_options(CLI::App& command, MaterialOptions& options) {
  add_parsed(command,
             {"--materials", "MODEL",
              "gltf, or diffuse: Lambert of the base colour, textures filtered as stored (default gltf)"},
             [&options](const std::string& text) { options.model = parse_model(text); });
  add_parsed(command, {"--albedo", "R[,G,B]", "Every surface a Lambert of this albedo, 0 to 1"},
             [&options](const std::string& text) { options.albedo = parse_albedo(text); });
}

void add_hide_backs(CLI::App& command, MaterialOptions& options) {
  add_flag(command, "--hide-backs", options.hide_backs,
           "Cameras see through the backs of single-sided surfaces, as viewers of glTF do; light does not");
}

renderer::MaterialOverride material_override(const MaterialOptions& options) {
  return {options.model.value_or(renderer::MaterialModel::kGltf), options.albedo, options.hide_backs};
}

std::string text_of_materials(const MaterialOptions& options) {
  if (options.albedo) return fmt::format("albedo {},{},{}", options.albedo->x, options.albedo->y, options.albedo->z);
  return options.model == renderer::MaterialModel::kDiffuse ? "diffuse" : "gltf";
}

}  // namespace chiaro::cli
