#pragma once
// What `inspect` says of each kind of file.

#include <string>
#include <vector>

#include "cli/json_output.h"
#include "cli/text_output.h"
#include "renderer/io/load_gltf.h"
#include "renderer/scene/light.h"

namespace chiaro::cli {

// The same facts for programs and for people.
struct Inspection {
  JsonObject summary;
  std::vector<TextRow> rows;
  std::vector<std::string> warnings;

  void add(const std::string& key, Json value, const std::string& label, const std::string& text);
};

// "kind" and "file", which every inspection starts with.
Inspection start_inspection(const std::string& kind, const std::string& file);

// control: to be interrupted.
Inspection inspect_scene(const std::string& file, const renderer::LoadOptions& load, const renderer::Control& control);
Inspection inspect_light_file(const std::string& file);
Inspection inspect_strokes(const std::string& file);
Inspection inspect_vertex_mesh(const std::string& file);  // receivers and targets
Inspection inspect_picture(const std::string& file);      // frames, other images, and transport caches

// The names, if any.
void add_variants(Inspection& inspection, const std::vector<std::string>& variants);

// One row per light; intensities in cd, illuminances in lux.
void add_lights(Inspection& inspection, const renderer::Lights& lights);

}  // namespace chiaro::cli
