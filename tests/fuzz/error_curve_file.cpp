// Summaries of earlier solves.

#include "inverse/solve/error_curve_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace chiaro;
  const std::filesystem::path path = fuzz::input_file("solve.json", fuzz::text_of(data, size));
  fuzz::read_or_refuse(path, [&] { inverse::load_error_curve(path); });
  return 0;
}
