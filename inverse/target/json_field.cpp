#include "inverse/target/json_field.h"

#include <algorithm>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/io/json_text.h"

namespace chiaro::inverse {

using nlohmann::json;

void JsonField::fail(std::string problem, std::string expected) const {
  throw renderer::Error({file, place, std::move(problem), std::move(expected)});
}

std::string JsonField::found() const {
  if (value.is_structured()) return fmt::format("an {} with {} inside", value.type_name(), value.size());
  const std::string text = value.dump();
  return text.size() <= 60 ? text : fmt::format("a {} of {} characters", value.type_name(), text.size());
}

JsonField JsonField::element(std::size_t i) const { return {file, fmt::format("{}[{}]", place, i), value.at(i)}; }

void expect_object(const JsonField& field, std::span<const std::string_view> known,
                   std::span<const std::string_view> needed) {
  if (!field.value.is_object()) field.fail_as_found("an object");
  for (const auto& [key, value] : field.value.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    field.fail("unknown key " + json(key).dump(), fmt::format("one of {}", fmt::join(known, ", ")));
  }
  for (const std::string_view key : needed) {
    if (!field.value.contains(key)) field.fail(fmt::format("has no \"{}\"", key), fmt::format("a \"{}\"", key));
  }
}

double read_double(const JsonField& field, JsonRange range, const char* expected) {
  if (!field.value.is_number()) field.fail_as_found(expected);
  const auto number = field.value.get<double>();
  if (!(float(number) >= range.low && float(number) <= range.high)) field.fail_as_found(expected);
  return number;
}

float read_number(const JsonField& field, JsonRange range, const char* expected) {
  return float(read_double(field, range, expected));
}

renderer::Vec3f read_triple(const JsonField& field, JsonRange range, const char* expected) {
  if (!field.value.is_array() || field.value.size() != 3) field.fail_as_found(expected);
  renderer::Vec3f triple;
  for (int i = 0; i < 3; ++i) triple[i] = read_number(field.element(std::size_t(i)), range, expected);
  return triple;
}

bool read_bool(const JsonField& field) {
  if (!field.value.is_boolean()) field.fail_as_found("true or false");
  return field.value.get<bool>();
}

json parse_json(const std::string& text, const std::string& file, const std::string& expected) {
  renderer::check_json_text(text, file);
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    // Without the library's own tag: "[json.exception.parse_error.101] parse error at line 1, column 2: …".
    const std::string_view what = error.what();
    const std::size_t tag = what.find("] ");
    throw renderer::Error({file, "", std::string(what.substr(tag == what.npos ? 0 : tag + 2)), expected});
  }
}

}  // namespace chiaro::inverse
