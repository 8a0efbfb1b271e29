#include "cli/scene_options.h"

#include "cli/add_options.h"

namespace chiaro::cli {

void add_scene_options(CLI::App& command, renderer::LoadOptions& options) {
  add_text(command, {"--variant", "NAME", "The scene's materials in this variant (KHR_materials_variants)"},
           options.variant);
}

}  // namespace chiaro::cli
