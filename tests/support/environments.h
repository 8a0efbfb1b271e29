#pragma once
// Environments made in code.

#include <utility>

#include "renderer/scene/light.h"

namespace chiaro::test {

// pixel(x, y): radiance.
template <class Pixel>
renderer::EnvironmentMap environment_map(int width, int height, const Pixel& pixel) {
  renderer::EnvironmentMap map{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) map.pixels.push_back(pixel(x, y));
  }
  return map;
}

inline renderer::EnvironmentLight environment(renderer::EnvironmentMap map, float rotation = 0) {
  renderer::EnvironmentLight light;
  light.name = "environment";
  light.map = std::make_shared<const renderer::EnvironmentMap>(std::move(map));
  light.rotation = rotation;
  return light;
}

}  // namespace chiaro::test
