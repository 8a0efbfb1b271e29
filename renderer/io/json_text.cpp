#include "renderer/io/json_text.h"

#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "renderer/core/error.h"
#include "renderer/core/shortened.h"

namespace chiaro::renderer {
namespace {

using nlohmann::json;

// Stops at the first.
class KeysOfObjects : public json::json_sax_t {
 public:
  const std::optional<std::string>& repeated() const { return repeated_; }

  bool key(string_t& name) override {
    if (open_.back().insert(name).second) return true;
    repeated_ = name;
    return false;
  }
  bool start_object(std::size_t) override {
    open_.emplace_back();
    return true;
  }
  bool end_object() override {
    open_.pop_back();
    return true;
  }

  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  std::vector<std::set<std::string>> open_;  // of each object around, the names so far
  std::optional<std::string> repeated_;
};

}  // namespace

void check_json_text(const std::string& text, const std::string& file) {
  constexpr std::string_view kFilling("\0 \t\r\n", 5);
  KeysOfObjects keys;
  const bool whole = json::sax_parse(text, &keys);
  if (keys.repeated()) throw Error({file, shortened(*keys.repeated(), 40), "is there twice in one object", "once"});
  const std::size_t end = text.find('\0');
  if (!whole || end == std::string::npos || text.find_first_not_of(kFilling, end) == std::string::npos) return;
  throw Error({file, "JSON", fmt::format("goes on behind a NUL at byte {}", end), "text"});
}

}  // namespace chiaro::renderer
