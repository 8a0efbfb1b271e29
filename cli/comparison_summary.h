#pragma once
// Figures of comparisons, for people and as JSON.

#include <string>

#include "cli/frame_comparison.h"
#include "cli/json_output.h"
#include "inverse/target/compare_targets.h"

namespace chiaro::cli {

JsonObject comparison_summary(const FrameComparison& comparison);
std::string comparison_text(const FrameComparison& comparison);

// `place`: where the receiver of the largest difference lies, metres.
JsonObject comparison_summary(const inverse::TargetComparison& comparison, renderer::Vec3f place);
std::string comparison_text(const inverse::TargetComparison& comparison, renderer::Vec3f place);

}  // namespace chiaro::cli
