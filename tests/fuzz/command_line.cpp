// Command lines: arguments with zeros between, run in a folder that has a scene, lights and a strokes file. Arguments
// that lead out of the folder are left out.

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "cli/program.h"
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

void enter_folder() {
  std::filesystem::current_path(folder());
  input_file("scene.gltf", kScene);
  input_file("lights.json", kLights);
  input_file("strokes.json", kStrokes);
}

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
  static const bool entered = (fuzz::enter_folder(), true);
  CHIARO_CHECK(entered);
  std::vector<std::string> arguments = fuzz::arguments_of(fuzz::text_of(data, size));
  fuzz::make_coarse(arguments);
  std::vector<const char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  const int code = cli::run_program(int(pointers.size()), pointers.data());
  constexpr std::array kKnown{cli::kDone, cli::kFailed, cli::kWrongUsage, cli::kLimitExceeded};
  CHIARO_CHECK(std::find(kKnown.begin(), kKnown.end(), code) != kKnown.end());
  return 0;
}
