#include "cli/run_page.h"

#include <fmt/format.h>

#include "cli/common_options.h"
#include "cli/embedded_file.h"
#include "cli/html.h"
#include "cli/solve_options.h"
#include "inverse/solve/not_told_apart.h"
#include "renderer/core/error.h"

namespace chiaro::cli {
namespace {

std::string definition(const std::string& name, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html_escaped(name), html_escaped(value));
}

std::string figures(const RunPage& page) {
  const inverse::SolveResult& result = page.result;
  std::string html = definition("lights found", fmt::format("{}", result.lights.size()));
  html += definition("error, traced afresh", text_of_percent(result.relative_l2));
  if (result.target_noise > 0) html += definition("noise of the target", text_of_percent(result.target_noise));
  html += definition("wanted on average (cd/m²)", fmt::format("{:.3g}", luminance(page.comparison.mean_b)));
  return html + definition("found on average (cd/m²)", fmt::format("{:.3g}", luminance(page.comparison.mean_a)));
}

std::string remarks(const inverse::SolveResult& result) {
  std::string text = fmt::format("Ended: {}.", inverse::words_for(result.termination));
  for (const std::vector<int>& group : inverse::groups_not_told_apart(result)) {
    text += fmt::format(" Of lights {} only the sum is known.", text_of_list(group));
  }
  for (const inverse::NotReached& place : result.not_reached) {
    text += fmt::format(" Not reached: {}.", text_of_place(place));
  }
  return html_escaped(result.advice.empty() ? text : text + " Advice: " + result.advice + ".");
}

std::string picture(const PageCamera& camera, const PagePicture& picture) {
  return fmt::format("<figure><img alt=\"{}: {}\" src=\"{}\"><figcaption><b>{}</b> {}</figcaption></figure>\n",
                     html_escaped(camera.name), html_escaped(picture.title), png_data_uri(picture.png),
                     html_escaped(picture.title), html_escaped(picture.text));
}

std::string cameras(const RunPage& page) {
  std::string html;
  for (const PageCamera& camera : page.cameras) {
    html += fmt::format("<h2>{}</h2>\n<div class=\"pictures\">\n", html_escaped(camera.name));
    for (const PagePicture& shown : camera.pictures) html += picture(camera, shown);
    html += "</div>\n";
  }
  return html;
}

std::string settings(const RunPage& page) {
  std::string html;
  for (const auto& [name, value] : page.settings) {
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", html_escaped(name), html_escaped(value));
  }
  return html;
}

std::string part(const RunPage& page, std::string_view name) {
  if (name == "scene") return html_escaped(page.scene);
  if (name == "version") return html_escaped(program_version());
  if (name == "wanted") return html_escaped(page.wanted);
  if (name == "figures") return figures(page);
  if (name == "remarks") return remarks(page.result);
  if (name == "cameras") return cameras(page);
  if (name == "lights") return light_rows(page);
  if (name == "settings") return settings(page);
  if (name == "command") return html_escaped(page.command);
  if (name == "to_the_bit") return page.time_limited ? ", as far as its time limit lets it come" : " to the bit";
  if (name == "summary") return html_escaped(json_text(without_seconds(page.summary)));
  const std::string_view file = embedded_file(name);
  CHIARO_CHECK(!file.empty());
  return std::string(file);
}

}  // namespace

std::string make_run_page(const RunPage& page) {
  return fill_in(embedded_file("run_page.html"), [&](std::string_view name) { return part(page, name); });
}

}  // namespace chiaro::cli
