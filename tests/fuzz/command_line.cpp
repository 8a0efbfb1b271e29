// Command lines: arguments with zeros between, run in a folder that has a scene and whatever else commands read, each
// time the same. Arguments that lead out of the folder are left out.

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.h"
#include "renderer/core/atomic_file.h"
#include "tests/fuzz/input_file.h"

namespace chiaro::fuzz {
namespace {

constexpr std::string_view kScene = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"name":"floor"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
constexpr std::string_view kLights = R"({"lights":[{"position":[0,0,1],"intensity":[1,1,1]}]})";
constexpr std::string_view kStrokes = R"({"strokes":[{"color":[1,1,1],"path":[[0.2,0.2,0]]}]})";
constexpr std::string_view kConstraints = R"({"max_intensity":10,"one_color":true})";

int run(const std::vector<std::string>& arguments) {
  std::vector<const char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  return cli::run_program(int(pointers.size()), pointers.data());
}

// The files of the folder, as they are at the start: those above and what commands make of them.
class Files {
 public:
  Files() {
    std::filesystem::current_path(folder());
    input_file("scene.gltf", kScene);
    input_file("lights.json", kLights);
    input_file("strokes.json", kStrokes);
    input_file("constraints.json", kConstraints);
    const auto make = [](const std::vector<std::string>& arguments) { CHIARO_CHECK(run(arguments) == cli::kDone); };
    const std::string scene = "scene.gltf", lights = "lights.json";
    make({"chiaro", "illuminate", scene, "--lights", lights, "-o", "t.glb", "--samples", "1", "--max-edge", "0.5"});
    make({"chiaro", "bake", scene, "-o", "c.exr", "--grid", "2,2,2", "--samples", "1", "--max-edge", "0.5"});
    make({"chiaro", "render", scene, "--lights", lights, "-o", "f.exr", "--width", "4", "--samples", "1"});
    for (const auto& entry : std::filesystem::directory_iterator(".")) {
      contents_.emplace_back(entry.path().filename().string(), renderer::read_file(entry.path()));
    }
  }

  void restore() const {
    for (const auto& entry : std::filesystem::directory_iterator(".")) std::filesystem::remove_all(entry.path());
    for (const auto& [name, bytes] : contents_) input_file(name, bytes);
  }

 private:
  std::vector<std::pair<std::string, std::string>> contents_;
};

// Fewer receivers and pixels than by default, and searches that end early, so that no input takes seconds.
void make_coarse(std::vector<std::string>& arguments) {
  struct Limit {
    std::string_view option, value;
    std::vector<std::string_view> commands;
  };
  static const std::array<Limit, 3> kLimits{{
      {"--max-edge", "0.2", {"receivers", "illuminate", "paint", "bake", "run"}},
      {"--width", "8", {"paint", "render", "run"}},
      {"--time-limit", "0.5", {"solve", "run"}},
  }};
  if (arguments.size() < 2) return;
  for (const Limit& limit : kLimits) {
    if (std::find(limit.commands.begin(), limit.commands.end(), arguments[1]) == limit.commands.end()) continue;
    const auto is_it = [&](const std::string& argument) { return argument.rfind(limit.option, 0) == 0; };
    if (std::any_of(arguments.begin(), arguments.end(), is_it)) continue;
    arguments.insert(arguments.end(), {std::string(limit.option), std::string(limit.value)});
  }
}

std::vector<std::string> arguments_of(std::string_view input) {
  std::vector<std::string> arguments{"chiaro"};
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\0'), input.size());
    if (input.substr(0, end).find('/') == std::string_view::npos) arguments.emplace_back(input.substr(0, end));
    input.remove_prefix(std::min(end + 1, input.size()));
  }
  return arguments;
}

}  // namespace
}  // namespace chiaro::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  static const fuzz::Files files;
  files.restore();
  std::vector<std::string> arguments = fuzz::arguments_of(fuzz::text_of(data, size));
  fuzz::make_coarse(arguments);
  const int code = fuzz::run(arguments);
  constexpr std::array kKnown{cli::kDone, cli::kFailed, cli::kWrongUsage, cli::kLimitExceeded};
  CHIARO_CHECK(std::find(kKnown.begin(), kKnown.end(), code) != kKnown.end());
  return 0;
}
