// Targets, as anyone may have written them.

#include <cmath>

#include "inverse/target/target.h"
#include "tests/fuzz/gltf_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::gltf_file(data, size);
  fuzz::read_or_refuse(path, [&] {
    const inverse::Target target = inverse::load_target(path);
    CHIARO_CHECK(target.illumination.size() == target.receivers.size());
    CHIARO_CHECK(target.weight.size() == target.receivers.size());
    for (const float weight : target.weight) CHIARO_CHECK(weight >= 0 && std::isfinite(weight));
  });
  return 0;
}
