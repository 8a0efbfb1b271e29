#include "cli/comparison_summary.h"

#include <cmath>

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

using Row = std::vector<std::string>;

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

std::string text_of(double figure, const std::string& unit = "") {
  return std::isnan(figure) ? "not known" : fmt::format("{:.4g}{}", figure, unit);
}

std::string text_of_mean(Vec3f mean, const std::string& unit) {
  return renderer::is_finite(mean) ? text_of_vector(mean) + unit : "not known";
}

// unit: of what is compared, after a blank; empty: it has none.
std::vector<TextRow> rows_of(const Figures& f, const std::string& unit, const std::string& place) {
  return {{"relative L2", text_of_percent(f.relative_l2)},
          {"RMSE", text_of(f.rmse, unit)},
          {"relative MSE", text_of(f.relative_mse)},
          {"PSNR", text_of(f.psnr, " dB")},
          {"mean of A", text_of_mean(f.mean_a, unit)},
          {"mean of B", text_of_mean(f.mean_b, unit)},
          {"largest difference", fmt::format("{} at {}", text_of(f.max_difference, unit), place)}};
}

using Channels = std::array<renderer::ChannelComparison, 3>;

JsonObject channels_of(const Channels& figures) {
  JsonObject channels;
  for (std::size_t i = 0; i < 3; ++i) {
    const renderer::ChannelComparison& f = figures[i];
    channels.emplace_back(std::string(1, "RGB"[i]), JsonObject{{"relative_l2", f.relative_l2},
                                                               {"rmse", f.rmse},
                                                               {"relative_mse", f.relative_mse},
                                                               {"psnr", f.psnr},
                                                               {"mean_a", f.mean_a},
                                                               {"mean_b", f.mean_b},
                                                               {"max_difference", f.max_difference}});
  }
  return channels;
}

JsonObject summary_of(const FrameFigures& f) {
  JsonObject summary = summary_of(figures_of(f.image), {f.image.max_x, f.image.max_y});
  summary.emplace_back("not_finite", std::int64_t(f.image.not_finite));
  summary.emplace_back("channels", channels_of(f.image.channels));
  if (f.flip) summary.emplace_back("flip", *f.flip);
  if (f.flip_hdr) summary.emplace_back("flip_hdr", *f.flip_hdr);
  return summary;
}

JsonObject summary_of(const NamedRegion& region, const FrameFigures& figures) {
  const renderer::PixelRegion& r = region.pixels;
  JsonObject summary{{"name", region.name}, {"crop", JsonList{r.x0, r.y0, r.x1, r.y1}}};
  for (auto& figure : summary_of(figures)) summary.push_back(std::move(figure));
  return summary;
}

std::string text_of(const std::optional<double>& flip) { return flip ? text_of(*flip) : "-"; }

std::string channel_table(const Channels& channels) {
  std::vector<Row> rows{{"channel", "relative L2", "RMSE", "PSNR", "largest"}};
  for (std::size_t i = 0; i < 3; ++i) {
    const renderer::ChannelComparison& f = channels[i];
    rows.push_back({std::string(1, "RGB"[i]), text_of_percent(f.relative_l2), text_of(f.rmse), text_of(f.psnr),
                    text_of(f.max_difference)});
  }
  return table(rows);
}

std::string region_table(const FrameComparison& comparison) {
  if (comparison.regions.empty()) return "";
  std::vector<Row> rows{{"region", "relative L2", "RMSE", "PSNR", "largest", "FLIP", "HDR-FLIP"}};
  for (std::size_t i = 0; i < comparison.regions.size(); ++i) {
    const FrameFigures& f = comparison.of_regions[i];
    rows.push_back({comparison.regions[i].name, text_of_percent(f.image.relative_l2), text_of(f.image.rmse),
                    text_of(f.image.psnr), text_of(f.image.max_difference), text_of(f.flip), text_of(f.flip_hdr)});
  }
  return "\n" + table(rows);
}

JsonList surfaces_of(const inverse::TargetComparison& comparison) {
  JsonList surfaces;
  for (const inverse::SurfaceComparison& f : comparison.surfaces) {
    surfaces.emplace_back(JsonObject{{"name", f.name},
                                     {"relative_l2", f.relative_l2},
                                     {"rmse", f.rmse},
                                     {"mean_a", f.mean_a},
                                     {"mean_b", f.mean_b},
                                     {"max_difference", f.max_difference}});
  }
  return surfaces;
}

// None of scenes of very many surfaces: --json has them.
std::string surface_table(const inverse::TargetComparison& comparison) {
  constexpr std::size_t kMostRows = 12;
  if (comparison.surfaces.size() < 2 || comparison.surfaces.size() > kMostRows) return "";
  std::vector<Row> rows{{"surface", "relative L2", "RMSE", "largest"}};
  for (const inverse::SurfaceComparison& f : comparison.surfaces) {
    rows.push_back({f.name, text_of_percent(f.relative_l2), text_of(f.rmse), text_of(f.max_difference)});
  }
  return "\n" + table(rows);
}

}  // namespace

JsonObject comparison_summary(const FrameComparison& comparison) {
  JsonObject summary = summary_of(comparison.whole);
  summary.emplace_back("scene_linear", comparison.scene_linear);
  if (comparison.exposure) summary.emplace_back("exposure", *comparison.exposure);
  if (const renderer::HdrFlip& hdr = comparison.hdr_flip; hdr.exposures > 0) {
    summary.emplace_back("flip_hdr_exposures",
                         JsonObject{{"start", hdr.start}, {"stop", hdr.stop}, {"count", hdr.exposures}});
  }
  JsonList regions;
  for (std::size_t i = 0; i < comparison.regions.size(); ++i) {
    regions.emplace_back(summary_of(comparison.regions[i], comparison.of_regions[i]));
  }
  if (!regions.empty()) summary.emplace_back("regions", std::move(regions));
  return summary;
}

std::string comparison_text(const FrameComparison& comparison) {
  const renderer::ImageComparison& image = comparison.whole.image;
  std::vector<TextRow> rows = rows_of(figures_of(image), "", fmt::format("pixel {}, {}", image.max_x, image.max_y));
  if (comparison.whole.flip) rows.emplace_back("FLIP", text_of(comparison.whole.flip));
  if (const renderer::HdrFlip& hdr = comparison.hdr_flip; hdr.exposures > 0) {
    rows.emplace_back("HDR-FLIP", fmt::format("{} over {} exposures, {:.3g} to {:.3g} EV",
                                              text_of(comparison.whole.flip_hdr), hdr.exposures, hdr.start, hdr.stop));
  }
  return aligned_rows(rows) + "\n" + channel_table(image.channels) + region_table(comparison);
}

JsonObject comparison_summary(const inverse::TargetComparison& comparison, Vec3f place) {
  JsonObject summary = summary_of(figures_of(comparison), {place.x, place.y, place.z});
  summary.emplace_back("max_receiver", comparison.max_at);
  summary.emplace_back("channels", channels_of(comparison.channels));
  summary.emplace_back("surfaces", surfaces_of(comparison));
  return summary;
}

std::string comparison_text(const inverse::TargetComparison& comparison, Vec3f place) {
  return aligned_rows(rows_of(figures_of(comparison), " cd/m²", text_of_vector(place) + " m")) + "\n" +
         channel_table(comparison.channels) + surface_table(comparison);
}

}  // namespace chiaro::cli
