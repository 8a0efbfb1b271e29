#include "renderer/image/radiance_header.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "renderer/core/error.h"

namespace chiaro::renderer {
namespace {

constexpr std::size_t kMostHeader = 1 << 16;  // bytes

struct Line {
  std::string name, value;
};

class HeaderReader {
 public:
  explicit HeaderReader(const std::filesystem::path& path) : file_(path.string()) {}

  void take(const Line& line) {
    if (line.name == "EXPOSURE") multiply(line, 1);
    if (line.name == "COLORCORR") multiply(line, 3);
    if (line.name == "PRIMARIES") set_primaries(line);
    if (line.name == "GAMMA" && numbers_of(line, 1).front() != 1) fail(line, "linear pixels");
    if (line.name == "FORMAT" && line.value != "32-bit_rle_rgbe") fail(line, "32-bit_rle_rgbe");
  }

  const RadianceHeader& header() const { return header_; }

 private:
  [[noreturn]] void fail(const Line& line, const std::string& expected) const {
    throw Error({file_, "header", fmt::format("{} is '{}'", line.name, line.value.substr(0, 100)), expected});
  }

  std::vector<float> numbers_of(const Line& line, std::size_t count) const {
    std::istringstream words(line.value);
    words.imbue(std::locale::classic());
    std::vector<float> numbers;
    for (float number = 0; words >> number;) numbers.push_back(number);
    const bool finite = std::all_of(numbers.begin(), numbers.end(), [](float n) { return std::isfinite(n); });
    if (numbers.size() != count || !words.eof() || !finite)
      fail(line, count == 1 ? "a number" : fmt::format("{} numbers", count));
    return numbers;
  }

  void multiply(const Line& line, std::size_t count) {
    const std::vector<float> factors = numbers_of(line, count);
    for (int c = 0; c < 3; ++c) header_.multiplied[c] *= factors[std::size_t(c) % count];
    const Vec3f all = header_.multiplied;
    if (!(min_component(all) > 1e-30F) || !(max_component(all) < 1e30F)) fail(line, "a factor");
  }

  void set_primaries(const Line& line) {
    const std::vector<float> numbers = numbers_of(line, 8);
    // As Photoshop and ImageMagick write what is not stated.
    if (std::all_of(numbers.begin(), numbers.end(), [](float n) { return n == 0; })) return;
    header_.chromaticities.emplace();
    std::copy(numbers.begin(), numbers.end(), header_.chromaticities->begin());
  }

  std::string file_;
  RadianceHeader header_;
};

}  // namespace

RadianceHeader read_radiance_header(const std::filesystem::path& path) {
  HeaderReader reader(path);
  std::ifstream stream(path, std::ios::binary);
  std::string text(kMostHeader, '\0');
  stream.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(stream.gcount()));
  std::istringstream lines(text.substr(0, text.find("\n\n")));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    const std::size_t begin = equals == std::string::npos ? equals : line.find_first_not_of(" \t", equals + 1);
    if (begin == std::string::npos) continue;
    reader.take({line.substr(0, equals), line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin)});
  }
  return reader.header();
}

}  // namespace chiaro::renderer
