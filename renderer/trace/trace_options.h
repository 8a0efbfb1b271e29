#pragma once

#include <cstdint>

namespace chiaro::renderer {

// Of frames and of illumination.
struct TraceOptions {
  int samples = 256;  // paths per point or pixel
  int bounces = -1;   // indirect bounces; 0 = direct only, -1 = until Russian roulette ends the path
  std::uint64_t seed = 0;
  bool scene_emission = true;  // the scene's emissive surfaces give light too
  // Mirrors show punctual lights as lamps of some size, and blurred in what they throw on other surfaces: bias for less
  // noise, in frames off unless asked for, in illumination always there.
  bool wide_highlights = false;
};

}  // namespace chiaro::renderer
