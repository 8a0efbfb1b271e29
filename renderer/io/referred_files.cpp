#include "renderer/io/referred_files.h"

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "renderer/io/gltf_container.h"
#include "renderer/io/gltf_uri.h"

namespace chiaro::renderer {
namespace {

using nlohmann::json;

// Takes down the strings under "uri" and "image". Nothing is kept of the rest, and so it may be long and deep.
class FileNames : public nlohmann::json_sax<json> {
 public:
  std::vector<std::string> names;

  bool key(string_t& name) override {
    names_a_file_ = name == "uri" || name == "image";
    return true;
  }
  bool string(string_t& text) override {
    if (names_a_file_ && !is_data_uri(text)) names.push_back(std::move(text));
    return pass();
  }
  bool null() override { return pass(); }
  bool boolean(bool) override { return pass(); }
  bool number_integer(number_integer_t) override { return pass(); }
  bool number_unsigned(number_unsigned_t) override { return pass(); }
  bool number_float(number_float_t, const string_t&) override { return pass(); }
  bool binary(binary_t&) override { return pass(); }
  bool start_object(std::size_t) override { return pass(); }
  bool end_object() override { return pass(); }
  bool start_array(std::size_t) override { return pass(); }
  bool end_array() override { return pass(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  bool pass() {
    names_a_file_ = false;
    return true;
  }
  bool names_a_file_ = false;
};

}  // namespace

std::vector<std::filesystem::path> referred_files(const std::filesystem::path& file) {
  FileNames found;
  json::sax_parse(read_gltf_json(file), &found);
  std::vector<std::filesystem::path> files;
  for (const std::string& uri : found.names) {
    for (const std::string& name : file_names_of(uri)) files.push_back(file.parent_path() / name);
  }
  return files;
}

}  // namespace chiaro::renderer
