#pragma once
// Summaries as JSON: ordered, and numbers as short as they can be without losing a bit.

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::cli {

struct Json;
using JsonList = std::vector<Json>;
using JsonObject = std::vector<std::pair<std::string, Json>>;

// A JSON value. Numbers that are not finite become null, as JSON has none.
struct Json {
  std::variant<bool, std::int64_t, double, std::string, JsonList, JsonObject> value;

  template <std::same_as<bool> T>
  Json(T v) : value(v) {}
  template <std::integral T>
  requires(!std::same_as<T, bool>) Json(T v) : value(std::int64_t(v)) {}
  Json(double v) : value(v) {}
  Json(std::optional<double> v) : value(v.value_or(std::numeric_limits<double>::quiet_NaN())) {}  // absent: null
  Json(float v);  // the double with the fewest digits that rounds to v
  Json(const char* v) : value(std::string(v)) {}
  Json(std::string v) : value(std::move(v)) {}
  Json(JsonList v) : value(std::move(v)) {}
  Json(JsonObject v) : value(std::move(v)) {}
  Json(renderer::Vec3f v);
};

// With the replacement character in place of bytes that are no UTF-8.
std::string valid_utf8(const std::string& text);

JsonList json_list(const std::vector<std::string>& texts);

// Two spaces a level; lists of numbers on one line; a line end at the end.
std::string json_text(const Json& json);

// Without the entries named "seconds", at any depth: for files that must be the same bytes each time.
Json without_seconds(const Json& json);

}  // namespace chiaro::cli
