// Constraints on lights.

#include "inverse/solve/light_constraints.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::input_file("constraints.json", fuzz::text_of(data, size));
  fuzz::read_or_refuse(path, [&] { inverse::load_constraints(path); });
  return 0;
}
