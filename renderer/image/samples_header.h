#pragma once

#include <cstdint>

namespace chiaro::renderer {

// ITU-T H.273, table 3: the curves that displays of a high range have, and none at all; nullptr: another.
inline const char* uncommon_curve(int transfer_characteristics) {
  switch (transfer_characteristics) {
    case 8:
      return "linear";
    case 16:
      return "PQ";
    case 18:
      return "HLG";
    default:
      return nullptr;
  }
}

// Of the samples that an encoded image holds.
struct SamplesHeader {
  int width = 0, height = 0;
  int channels = 0;             // grey, grey and alpha, RGB or RGBA; palettes are looked up
  int bytes_per_sample = 1;     // or 2, in the order of this machine
  const char* curve = nullptr;  // that the file says they have, where it is not one of common displays
  int orientation = 1;          // as in image_orientation.h

  std::uintmax_t bytes() const { return std::uintmax_t(width) * height * channels * bytes_per_sample; }
};

}  // namespace chiaro::renderer
