#include "cli/comparison_summary.h"

#include <fmt/format.h>

#include "cli/text_output.h"

namespace chiaro::cli {
namespace {

using renderer::Vec3f;

// What both kinds of comparison have.
struct Figures {
  double relative_l2, rmse, relative_mse, psnr;
  Vec3f mean_a, mean_b;
  double max_difference;
};

Vec3f vector_of(const std::array<double, 3>& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

Figures figures_of(const renderer::ImageComparison& c) {
  return {c.relative_l2, c.rmse, c.relative_mse, c.psnr, vector_of(c.mean_a), vector_of(c.mean_b), c.max_difference};
}

Figures figures_of(const inverse::TargetComparison& c) {
  return {c.relative_l2, c.rmse, c.relative_mse, c.psnr, c.mean_a, c.mean_b, c.max_difference};
}

JsonObject summary_of(const Figures& f, JsonList max_at) {
  return {{"relative_l2", f.relative_l2},
          {"rmse", f.rmse},
          {"relative_mse", f.relative_mse},
          {"psnr", f.psnr},
          {"mean_a", f.mean_a},
          {"mean_b", f.mean_b},
          {"max_difference", f.max_difference},
          {"max_at", std::move(max_at)}};
}

std::string text_of(const Figures& f, const std::string& place) {
  return aligned_rows({{"relative L2", text_of_percent(f.relative_l2)},
                       {"RMSE", fmt::format("{:.4g}", f.rmse)},
                       {"relative MSE", fmt::format("{:.4g}", f.relative_mse)},
                       {"PSNR", fmt::format("{:.4g} dB", f.psnr)},
                       {"mean of A", text_of_vector(f.mean_a)},
                       {"mean of B", text_of_vector(f.mean_b)},
                       {"largest difference", fmt::format("{:.4g} at {}", f.max_difference, place)}});
}

}  // namespace

JsonObject comparison_summary(const renderer::ImageComparison& comparison) {
  JsonObject summary = summary_of(figures_of(comparison), {comparison.max_x, comparison.max_y});
  summary.emplace_back("not_finite", comparison.not_finite);
  return summary;
}

std::string comparison_text(const renderer::ImageComparison& comparison) {
  return text_of(figures_of(comparison), fmt::format("pixel {}, {}", comparison.max_x, comparison.max_y));
}

JsonObject comparison_summary(const inverse::TargetComparison& comparison, Vec3f place) {
  JsonObject summary = summary_of(figures_of(comparison), {place.x, place.y, place.z});
  summary.emplace_back("max_receiver", comparison.max_at);
  return summary;
}

std::string comparison_text(const inverse::TargetComparison& comparison, Vec3f place) {
  return text_of(figures_of(comparison), text_of_vector(place) + " m");
}

}  // namespace chiaro::cli
