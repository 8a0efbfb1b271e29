#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "inverse/transport/receivers.h"

namespace chiaro::inverse {

// Wanted illumination: what somebody painted.
struct Target {
  Receivers receivers;
  std::vector<Vec3f> illumination;         // cd/m² per receiver
  std::vector<float> weight;               // per receiver, ≥ 0
  std::vector<float> standard_error;       // cd/m² per receiver; empty: not known
  bool has_scaled_colors = false;          // some of it is COLOR_0 times a target's scale
  std::vector<std::string> warnings = {};  // one line each, naming the file that it was read from: what was left out
};

constexpr float kDimmest = 1e-18F;  // cd/m² that lights are found for: at some receiver whose weight is not 0

bool wants_light(const Target& target);
// Error, naming `file`, where every weight is 0.
void require_weight(const Target& target, const std::string& file);

// `.glb`/`.gltf` with _ILLUMINATION, or COLOR_0 × target_scale (cd/m²) where that is absent. Error where a file has
// neither ("an empty target"), or where it wants no light.
Target load_target(const std::filesystem::path& path, float target_scale = 1);
// The same, which may want none.
Target load_illumination(const std::filesystem::path& path, float target_scale = 1);
// Error, naming the vertex, for illumination that load_target would refuse.
void save_target(const Target& target, const std::filesystem::path& path);

// _STANDARD_ERROR of a traced illumination: root mean square over the channels. Empty where it is not known.
std::vector<float> standard_error_per_receiver(const renderer::Illumination& illumination);

// ‖a − b‖ / ‖b‖ over receivers and channels, each receiver weighted (eq. 3.6). b is the reference.
double relative_l2(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b, const std::vector<float>& weight);

}  // namespace chiaro::inverse
