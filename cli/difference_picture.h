#pragma once

#include <filesystem>

#include "cli/view_options.h"
#include "renderer/image/image.h"

namespace chiaro::cli {

// By its extension: formats that hold floats hold scene-linear values.
bool is_scene_linear(const std::filesystem::path& file);

// A, B and |A − B| × 8, each as the view shows it, side by side. An automatic exposure is that of B.
renderer::Image scene_linear_picture(const renderer::Image& a, const renderer::Image& b, ViewChoice view);

}  // namespace chiaro::cli
