#pragma once
// Sums of samples per pixel and layer.

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/image/image.h"
#include "renderer/trace/path_tracer.h"

namespace chiaro::renderer {

struct PixelSample {
  bool hit = false;
  Vec3f beauty, albedo, normal, position, illumination;
  float depth = 0;  // metres along the ray
  PathLight light;
};

// Which layers are on, and where their channels stand in the image: found once, used per sample.
class Film {
 public:
  Film(int width, int height, const std::vector<std::string>& layers, const Lights& lights);

  bool wants_illumination() const { return illumination_ >= 0; }
  std::size_t light_layers() const { return lights_.size(); }
  void add(int x, int y, const PixelSample& sample);
  // Means; position, depth and normal are means over the samples that hit something. relative_standard_error: of the
  // frame.
  Image finish(int samples, double& relative_standard_error) const;

 private:
  int width_, height_;
  std::vector<std::string> names_;
  std::size_t stride_;
  int albedo_ = -1, normal_ = -1, position_ = -1, depth_ = -1, direct_ = -1, indirect_ = -1, illumination_ = -1,
      variance_ = -1;
  std::vector<int> lights_;      // channel of each light's layer, emissive surfaces last
  std::vector<double> sums_;     // per pixel and channel
  std::vector<double> squares_;  // per pixel: Σ beauty², three channels
};

}  // namespace chiaro::renderer
