#include "cli/scene_options.h"

#include <CLI/CLI.hpp>

#include "cli/add_options.h"

namespace chiaro::cli {

void add_scene_options(CLI::App& command, renderer::LoadOptions& options) {
  add_text(command, {"--variant", "NAME", "The scene's materials in this variant (KHR_materials_variants)"},
           options.variant);
  add_text(command,
           {"--animation", "NAME|INDEX",
            "The animation that --animation-time is of (default: all of the scene, if no two move the same thing; else "
            "the first)"},
           options.animation.animation);
  add_number(command,
             {"--animation-time", "SECONDS", "The scene as it is then (default: as its nodes stand, nothing animated)"},
             options.animation.seconds, {.min = -1e30, .max = 1e30});
  command.get_option("--animation")->needs("--animation-time");
  command.add_flag_callback(
      "--allow-external", [&options] { options.external = renderer::ExternalFiles::kAnywhere; },
      "Let the scene open files outside its folder");
}

std::vector<std::string> scene_option_names() {
  return {"--variant", "--animation", "--animation-time", "--allow-external"};
}

}  // namespace chiaro::cli
