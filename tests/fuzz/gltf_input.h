#pragma once
// Inputs that become glTF files: a file as it is, or JSON text, a zero and the bytes of a GLB's binary chunk, whose
// headers then fit whatever the fuzzer makes of the contents.

#include <string>

#include "renderer/io/gltf_container.h"
#include "tests/fuzz/input_file.h"

namespace chiaro::fuzz {

inline std::string glb_of(std::string_view input) {
  renderer::GltfContainer container;
  const std::size_t end = input.find('\0');
  container.json = input.substr(0, end);
  if (end != std::string_view::npos) container.binary = input.substr(end + 1);
  return make_glb(container, "scene.glb");
}

inline std::filesystem::path gltf_file(const std::uint8_t* data, std::size_t size) {
  const std::string_view input = text_of(data, size);
  return input_file("scene.glb", renderer::is_glb(input) ? std::string(input) : glb_of(input));
}

}  // namespace chiaro::fuzz
