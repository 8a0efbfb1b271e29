#include "renderer/trace/film.h"

#include <fmt/format.h>

#include <set>

#include "renderer/core/error.h"
#include "renderer/trace/render.h"

namespace chiaro::renderer {
namespace {

// Layer names are unique and hold no dot, which separates layers in EXR.
std::string light_layer_name(const Light& light, std::size_t index, std::set<std::string>& taken) {
  std::string name = name_of(light).empty() ? fmt::format("{}", index) : name_of(light);
  for (char& c : name) {
    if (c == '.' || c == ' ') c = '_';
  }
  while (!taken.insert(name).second) name += fmt::format("_{}", index);
  return "light." + name;
}

void add3(double* sums, Vec3f v) {
  for (int c = 0; c < 3; ++c) sums[c] += double(v[c]);
}

}  // namespace

const std::vector<std::string>& frame_layers() {
  static const std::vector<std::string> names{"albedo",   "normal",       "position", "depth", "direct",
                                              "indirect", "illumination", "variance", "lights"};
  return names;
}

Film::Film(int width, int height, const std::vector<std::string>& layers, const Lights& lights)
    : width_(width), height_(height), names_{"R", "G", "B", "A"} {
  const auto add_layer = [&](const std::string& name, std::initializer_list<const char*> channels) {
    const int first = int(names_.size());
    for (const char* channel : channels) names_.push_back(name + "." + channel);
    return first;
  };
  for (const std::string& layer : layers) {
    if (layer == "albedo")
      albedo_ = add_layer(layer, {"R", "G", "B"});
    else if (layer == "normal")
      normal_ = add_layer(layer, {"X", "Y", "Z"});
    else if (layer == "position")
      position_ = add_layer(layer, {"X", "Y", "Z"});
    else if (layer == "depth")
      depth_ = add_layer(layer, {"Z"});
    else if (layer == "direct")
      direct_ = add_layer(layer, {"R", "G", "B"});
    else if (layer == "indirect")
      indirect_ = add_layer(layer, {"R", "G", "B"});
    else if (layer == "illumination")
      illumination_ = add_layer(layer, {"R", "G", "B"});
    else if (layer == "variance")
      variance_ = add_layer(layer, {"R", "G", "B"});
    else if (layer == "lights") {
      std::set<std::string> taken{"emission"};
      for (std::size_t i = 0; i < lights.size(); ++i) {
        lights_.push_back(add_layer(light_layer_name(lights[i], i, taken), {"R", "G", "B"}));
      }
      lights_.push_back(add_layer("light.emission", {"R", "G", "B"}));
    } else {
      throw Error(
          {"", "layers", fmt::format("no layer \"{}\"", layer), fmt::format("{}", fmt::join(frame_layers(), ", "))});
    }
  }
  stride_ = names_.size();
  sums_.assign(std::size_t(width) * height * stride_, 0);
  squares_.assign(std::size_t(width) * height * 3, 0);
}

void Film::add(int x, int y, const PixelSample& s) {
  const std::size_t pixel = std::size_t(y) * width_ + x;
  double* sums = &sums_[pixel * stride_];
  add3(sums, s.beauty);
  sums[3] += s.hit ? 1 : 0;
  add3(&squares_[3 * pixel], s.beauty * s.beauty);
  if (albedo_ >= 0) add3(sums + albedo_, s.albedo);
  if (normal_ >= 0) add3(sums + normal_, s.normal);
  if (position_ >= 0) add3(sums + position_, s.position);
  if (depth_ >= 0) sums[depth_] += double(s.depth);
  if (direct_ >= 0) add3(sums + direct_, s.light.direct);
  if (indirect_ >= 0) add3(sums + indirect_, s.light.indirect);
  if (illumination_ >= 0) add3(sums + illumination_, s.illumination);
  for (std::size_t i = 0; i < lights_.size(); ++i) add3(sums + lights_[i], s.light.per_light[i]);
}

Image Film::finish(int samples, double& relative_standard_error) const {
  Image image = make_image(width_, height_, names_);
  double error = 0, value = 0;
  for (std::size_t pixel = 0; pixel < std::size_t(width_) * height_; ++pixel) {
    const double* sums = &sums_[pixel * stride_];
    float* out = &image.pixels[pixel * stride_];
    for (std::size_t c = 0; c < stride_; ++c) out[c] = float(sums[c] / samples);
    const double hits = sums[3];
    for (const int first : {normal_, position_}) {
      for (int c = 0; first >= 0 && c < 3; ++c) out[first + c] = hits > 0 ? float(sums[first + c] / hits) : 0.0F;
    }
    if (depth_ >= 0) out[depth_] = hits > 0 ? float(sums[depth_] / hits) : kInfinity;
    for (int c = 0; c < 3; ++c) {
      const double mean = sums[c] / samples;
      const double variance = std::max(0.0, squares_[3 * pixel + c] / samples - mean * mean) / std::max(1, samples - 1);
      if (variance_ >= 0) out[variance_ + c] = float(variance);
      error += variance;
      value += mean * mean;
    }
  }
  relative_standard_error = value > 0 ? std::sqrt(error / value) : 0;
  return image;
}

}  // namespace chiaro::renderer
