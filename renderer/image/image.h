#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace chiaro::renderer {

// Float pixels with named channels, rows from the top, channels interleaved.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channel_names;  // EXR names: "R", "G", "B", "albedo.R", …
  std::vector<float> pixels;               // width * height * channel_names.size()

  int channel_count() const { return int(channel_names.size()); }
  int find_channel(const std::string& name) const {  // -1: none
    for (int c = 0; c < channel_count(); ++c) {
      if (channel_names[c] == name) return c;
    }
    return -1;
  }
  float* at(int x, int y) { return &pixels[(std::size_t(y) * width + x) * channel_names.size()]; }
  const float* at(int x, int y) const { return &pixels[(std::size_t(y) * width + x) * channel_names.size()]; }
};

inline Image make_image(int width, int height, std::vector<std::string> channel_names) {
  Image image{width, height, std::move(channel_names), {}};
  image.pixels.assign(std::size_t(width) * height * image.channel_names.size(), 0.0F);
  return image;
}

}  // namespace chiaro::renderer
