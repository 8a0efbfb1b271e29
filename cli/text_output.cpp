#include "cli/text_output.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

#include <fmt/format.h>

#include "cli/json_output.h"
#include "cli/terminal_text.h"
#include "renderer/core/error.h"

namespace chiaro::cli {

std::string aligned_rows(const std::vector<TextRow>& rows) {
  std::vector<TextRow> lines;
  std::size_t width = 0;
  for (const auto& [name, value] : rows) {
    lines.emplace_back(one_line(name), one_line(value));
    width = std::max(width, lines.back().first.size());
  }
  std::string text;
  for (const auto& [name, value] : lines) text += fmt::format("  {:{}}  {}\n", name, width, value);
  return text;
}

std::string table(std::vector<std::vector<std::string>> rows) {
  std::vector<std::size_t> widths;
  for (auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) {
      row[c] = one_line(row[c]);
      widths[c] = std::max(widths[c], row[c].size());
    }
  }
  std::string text;
  for (const auto& row : rows) {
    text += "  ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += c == 0 ? fmt::format("{:<{}}", row[c], widths[c]) : fmt::format("  {:>{}}", row[c], widths[c]);
    }
    text += "\n";
  }
  return text;
}

double degrees_of(double radians) { return radians * (180 / std::numbers::pi); }

std::string text_of_vector(renderer::Vec3f v) { return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z); }

std::string text_of_seconds(double seconds) {
  if (seconds < 59.95) return fmt::format("{:.2f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string text_of_percent(std::optional<double> fraction) {
  return fraction && !std::isnan(*fraction) ? fmt::format("{:.3g} %", 100 * *fraction) : "not known";
}

std::string text_of_bytes(double bytes) {
  const char* units[] = {"bytes", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  for (; bytes >= 1000 && unit + 1 < std::size(units); ++unit) bytes /= 1000;
  return fmt::format("{:.4g} {}", bytes, units[unit]);
}

std::string text_of_interval(renderer::Vec3f half) {
  const float widest = max_component(half);
  return std::isfinite(widest) ? fmt::format("{:.2g}", widest) : "not known";
}

std::string one_line(const std::string& text) {
  std::string line = without_controls(valid_utf8(text), [](char32_t) { return " "; });
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

void print(const std::string& text) {
  const std::string shown =
      without_controls(valid_utf8(text), [](char32_t control) { return control == U'\n' ? "\n" : " "; });
  if (std::fwrite(shown.data(), 1, shown.size(), stdout) == shown.size() && std::fflush(stdout) == 0) return;
  if (errno == EINTR) throw renderer::Interruption();
  throw renderer::Error({"standard output", "", fmt::format("cannot be written: {}", std::strerror(errno)), ""});
}

void print_message(const std::string& text) { std::fprintf(stderr, "chiaro: %s\n", one_line(text).c_str()); }

}  // namespace chiaro::cli
