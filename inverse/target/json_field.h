#pragma once
// Reading JSON files that people write: every fault is told with its place. For the .cpp files of such readers alone.

#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "renderer/core/atomic_file.h"
#include "renderer/core/vec.h"

namespace chiaro::inverse {

// A value of the file and where it stands, for messages.
struct JsonField {
  const std::string& file;
  std::string place;
  const nlohmann::json& value;

  [[noreturn]] void fail(std::string problem, std::string expected) const;
  [[noreturn]] void fail_as_found(std::string expected) const { fail("is " + found(), std::move(expected)); }
  // Never the inside of arrays and objects, which may be long and deep.
  std::string found() const;
  bool has(const std::string& name) const { return value.contains(name); }
  JsonField member(const std::string& name) const {
    return {file, place.empty() ? name : place + "." + name, value.at(name)};
  }
  JsonField element(std::size_t i) const;
};

void expect_object(const JsonField& field, std::span<const std::string_view> known,
                   std::span<const std::string_view> needed);

struct JsonRange {
  float low = std::numeric_limits<float>::lowest();
  float high = std::numeric_limits<float>::max();
};
inline constexpr JsonRange kNotNegative{0, std::numeric_limits<float>::max()};
inline constexpr JsonRange kPositive{std::numeric_limits<float>::min(), std::numeric_limits<float>::max()};

// A number that as a float lies in `range`; one too large for a float is infinite, and so outside.
double read_double(const JsonField& field, JsonRange range, const char* expected);
float read_number(const JsonField& field, JsonRange range, const char* expected);
renderer::Vec3f read_triple(const JsonField& field, JsonRange range, const char* expected);
bool read_bool(const JsonField& field);

nlohmann::json parse_json(const std::string& text, const std::string& file, const std::string& expected);

// What `read` makes of the file. expected: what kind of file it should be, for messages.
template <class Read>
auto read_json_file(const std::filesystem::path& path, const std::string& expected, const Read& read) {
  const std::string file = path.string();
  const nlohmann::json document = parse_json(renderer::read_file(path), file, expected);
  return read(JsonField{file, "", document});
}

}  // namespace chiaro::inverse
