#include <cmath>

#include <fmt/format.h>

#include "cli/html.h"
#include "cli/run_page.h"
#include "cli/text_output.h"
#include "renderer/core/color_temperature.h"
#include "renderer/image/srgb_curve.h"
#include "renderer/scene/luminous_flux.h"

namespace chiaro::cli {
namespace {

using renderer::Light;
using renderer::Vec3f;

// What a table says of a light of any kind.
struct LightText {
  std::string place, aim, brightness;
  Vec3f color;
};

std::string text_of_aim(Vec3f direction) { return "towards " + text_of_vector(direction); }

LightText text_of(const renderer::PointLight& light) {
  return {text_of_vector(light.position), "", text_of_vector(light.intensity), light.intensity};
}
LightText text_of(const renderer::SpotLight& light) {
  return {text_of_vector(light.position),
          fmt::format("{}, cone {:.3g}° to {:.3g}°", text_of_aim(light.direction), degrees_of(light.inner_cone_angle),
                      degrees_of(light.outer_cone_angle)),
          text_of_vector(light.intensity), light.intensity};
}
LightText text_of(const renderer::DirectionalLight& light) {
  return {"from afar", text_of_aim(light.direction), text_of_vector(light.illuminance) + " lx", light.illuminance};
}
LightText text_of(const renderer::EnvironmentLight& light) { return {"all around", light.image, "", {}}; }

std::string text_of_flux(const Light& light) {
  const auto lumens = luminous_flux(light);
  return lumens ? fmt::format("{:.3g} lm", *lumens) : "—";
}

std::string text_of_temperature(Vec3f color) {
  const auto temperature = renderer::correlated_color_temperature(color);
  if (!temperature) return "—";
  return fmt::format("{:.0f} K<small>Duv {:+.4f}</small>", temperature->kelvin, temperature->duv);
}

// The colour at full brightness, on the sRGB curve.
std::string swatch(Vec3f color) {
  const float most = max_component(color);
  std::array<int, 3> bytes{};
  for (int c = 0; c < 3 && most > 0; ++c) {
    bytes[std::size_t(c)] = int(std::lround(255 * renderer::srgb_from_linear(std::max(0.0F, color[c] / most))));
  }
  return fmt::format(
      "<svg class=\"swatch\" viewBox=\"0 0 2 2\"><circle cx=\"1\" cy=\"1\" r=\"1\" "
      "fill=\"#{:02x}{:02x}{:02x}\"/></svg>",
      bytes[0], bytes[1], bytes[2]);
}

std::string cell(const char* label, const std::string& html) {
  return fmt::format("<td data-label=\"{}\"><span>{}</span></td>", label, html);
}

std::string small(const std::string& text) { return text.empty() ? "" : "<small>" + html_escaped(text) + "</small>"; }

std::string interval(Vec3f half) { return max_component(half) > 0 ? "± " + text_of_interval(half) : ""; }

struct LightRow {
  std::string number, contribution, position_interval, intensity_interval;
};

std::string row(const Light& light, const LightRow& given) {
  const LightText text = std::visit([](const auto& l) { return text_of(l); }, light);
  return "<tr>" + cell("light", swatch(text.color) + given.number + small(name_of(light))) +
         cell("position (m)", html_escaped(text.place) + small(text.aim) + small(given.position_interval)) +
         cell("intensity (cd)", html_escaped(text.brightness) + small(given.intensity_interval)) +
         cell("flux", text_of_flux(light)) + cell("colour", text_of_temperature(text.color)) +
         cell("contribution", given.contribution) + "</tr>\n";
}

}  // namespace

std::string light_rows(const RunPage& page) {
  std::string html;
  int number = 0;
  for (const inverse::FoundLight& found : page.result.lights) {
    html += row(found.light, {fmt::format("{}", ++number), text_of_percent(found.contribution),
                              interval(found.position_interval), interval(found.intensity_interval)});
  }
  for (const Light& kept : page.kept_lights) html += row(kept, {"kept", "", "", ""});
  return html;
}

}  // namespace chiaro::cli
