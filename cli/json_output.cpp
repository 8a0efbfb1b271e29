#include "cli/json_output.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/terminal_text.h"

namespace chiaro::cli {
namespace {

// What terminals obey is escaped, whether or not JSON asks for it.
std::string quoted(const std::string& text) {
  return without_controls(nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
                          [](char32_t control) { return fmt::format("\\u{:04x}", std::uint32_t(control)); });
}

std::string indentation(int level) { return "\n" + std::string(std::size_t(2 * level), ' '); }

bool is_plain(const Json& json) { return json.value.index() < 4; }

std::string text_of(const Json& json, int level);

struct Writer {
  int level;

  std::string operator()(bool v) const { return v ? "true" : "false"; }
  std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
  std::string operator()(double v) const { return std::isfinite(v) ? nlohmann::json(v).dump() : "null"; }
  std::string operator()(const std::string& v) const { return quoted(v); }

  std::string operator()(const JsonList& list) const {
    if (list.empty()) return "[]";
    const bool one_line = std::all_of(list.begin(), list.end(), is_plain);
    std::string text;
    for (const Json& item : list) {
      text += text.empty() ? "[" : one_line ? ", " : ",";
      if (!one_line) text += indentation(level + 1);
      text += text_of(item, level + 1);
    }
    return text + (one_line ? "]" : indentation(level) + "]");
  }

  std::string operator()(const JsonObject& object) const {
    if (object.empty()) return "{}";
    std::string text;
    for (const auto& [key, item] : object) {
      text += text.empty() ? "{" : ",";
      text += indentation(level + 1) + quoted(key) + ": " + text_of(item, level + 1);
    }
    return text + indentation(level) + "}";
  }
};

std::string text_of(const Json& json, int level) { return std::visit(Writer{level}, json.value); }

}  // namespace

Json::Json(float v) : value(std::isfinite(v) ? std::strtod(fmt::format("{}", v).c_str(), nullptr) : double(v)) {}

Json::Json(renderer::Vec3f v) : value(JsonList{v.x, v.y, v.z}) {}

std::string valid_utf8(const std::string& text) { return nlohmann::json::parse(quoted(text)).get<std::string>(); }

JsonList json_list(const std::vector<std::string>& texts) { return {texts.begin(), texts.end()}; }

std::string json_text(const Json& json) { return text_of(json, 0) + "\n"; }

Json without_seconds(const Json& json) {
  if (const auto* list = std::get_if<JsonList>(&json.value)) {
    JsonList kept;
    for (const Json& item : *list) kept.push_back(without_seconds(item));
    return kept;
  }
  if (const auto* object = std::get_if<JsonObject>(&json.value)) {
    JsonObject kept;
    for (const auto& [key, item] : *object) {
      if (key != "seconds") kept.emplace_back(key, without_seconds(item));
    }
    return kept;
  }
  return json;
}

}  // namespace chiaro::cli
