#include "renderer/trace/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "renderer/core/error.h"
#include "renderer/core/shortened.h"
#include "renderer/trace/render.h"

namespace chiaro::renderer {
namespace {

constexpr std::size_t kLongestName = 200;  // bytes of a light's; OpenEXR's channels have up to 255

// Layer names are unique, and hold no dot, which separates layers in EXR, and nothing that a name ends at.
std::string light_layer_name(const Light& light, std::size_t index, std::set<std::string>& taken) {
  std::string name = name_of(light).empty() ? fmt::format("{}", index) : name_of(light);
  name = shortened(name, kLongestName);
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '.' || byte <= ' ' || byte == 0x7F) c = '_';
  }
  while (!taken.insert(name).second) name += fmt::format("_{}", index);
  return "light." + name;
}

void add3(double* sums, Vec3f v) {
  for (int c = 0; c < 3; ++c) sums[c] += double(v[c]);
}

// Of what is more than any float, the largest: no layer holds what is not a number.
float held(double value) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return float(std::clamp(value, -kMost, kMost));
}

}  // namespace

const std::vector<std::string>& frame_layers() {
  static const std::vector<std::string> names{"albedo",  "normal",   "position",     "depth",
                                              "direct",  "indirect", "illumination", "variance",
                                              "samples", "lights",   "cryptomatte"};
  return names;
}

Film::Film(int width, int height, const std::vector<std::string>& layers, const Lights& lights, int samples)
    : width_(width), height_(height), samples_(samples), names_{"R", "G", "B", "A"} {
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
    else if (layer == "samples")
      samples_layer_ = add_layer(layer, {"Y"});
    else if (layer == "lights") {
      std::set<std::string> taken{"emission"};
      for (std::size_t i = 0; i < lights.size(); ++i) {
        lights_.push_back(add_layer(light_layer_name(lights[i], i, taken), {"R", "G", "B"}));
      }
      lights_.push_back(add_layer("light.emission", {"R", "G", "B"}));
    } else if (layer == "cryptomatte") {
      mattes_wanted_ = true;
      for (int k = 0; k < 2; ++k) {
        matte_layers_[k] = int(names_.size());
        for (std::string& name : matte_channels(kMatteLayers[k])) names_.push_back(std::move(name));
      }
    } else {
      throw Error(
          {"", "layers", fmt::format("no layer \"{}\"", layer), fmt::format("{}", fmt::join(frame_layers(), ", "))});
    }
  }
  stride_ = names_.size();
  const std::size_t pixels = std::size_t(width) * height;
  layers_.assign(pixels * 2 * stride_, 0);
  batches_.assign(pixels * kBatches * 3, 0);
  for (auto& mattes : mattes_) mattes.resize(mattes_wanted_ ? pixels : 0);
  tile_columns_ = (width + kTileSide - 1) / kTileSide;
  for (int y = 0; y < height; y += kTileSide) {
    for (int x = 0; x < width; x += kTileSide) {
      tiles_.push_back({x, y, std::min(x + kTileSide, width), std::min(y + kTileSide, height)});
    }
  }
  asked_.assign(tiles_.size(), {0, 0});
  dropped_.assign(tiles_.size(), 0);
}

TileSums Film::make_sums(std::size_t tile) const {
  const std::size_t pixels = std::size_t(tiles_[tile].pixels());
  TileSums sums;
  sums.layers.assign(pixels * 2 * stride_, 0);
  sums.batches.assign(pixels * kBatches * 3, 0);
  for (auto& mattes : sums.mattes) mattes.resize(mattes_wanted_ ? pixels : 0);
  return sums;
}

void Film::add(TileSums& tile, int pixel, int batch, const PixelSample& s) const {
  const int half = batch & 1;
  double* sums = &tile.layers[(2 * std::size_t(pixel) + std::size_t(half)) * stride_];
  add3(&tile.batches[3 * (std::size_t(pixel) * kBatches + std::size_t(batch))], s.beauty);
  add3(sums, s.beauty);
  sums[3] += s.hit ? 1 : 0;
  if (albedo_ >= 0) add3(sums + albedo_, s.albedo);
  if (normal_ >= 0) add3(sums + normal_, s.normal);
  if (position_ >= 0) add3(sums + position_, s.position);
  if (depth_ >= 0) sums[depth_] += double(s.depth);
  if (direct_ >= 0) add3(sums + direct_, s.light.direct);
  if (indirect_ >= 0) add3(sums + indirect_, s.light.indirect);
  if (illumination_ >= 0) add3(sums + illumination_, s.illumination);
  for (std::size_t i = 0; i < lights_.size(); ++i) add3(sums + lights_[i], s.light.per_light[i]);
  if (!mattes_wanted_ || !s.hit) return;
  add_matte(tile.mattes[0][std::size_t(pixel)], s.object, half, 1);
  add_matte(tile.mattes[1][std::size_t(pixel)], s.material, half, 1);
}

std::size_t Film::index(std::size_t tile, int pixel) const {
  const FilmTile& t = tiles_[tile];
  return std::size_t(t.y0 + pixel / t.width()) * width_ + t.x0 + pixel % t.width();
}

void Film::merge(std::size_t tile, const TileSums& sums, std::array<int, 2> batch_samples) {
  const auto add_all = [](float* to, const double* from, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) to[i] = held(double(to[i]) + from[i]);
  };
  for (int pixel = 0; pixel < tiles_[tile].pixels(); ++pixel) {
    const std::size_t at = index(tile, pixel), p = std::size_t(pixel);
    add_all(&layers_[at * 2 * stride_], &sums.layers[p * 2 * stride_], 2 * stride_);
    add_all(&batches_[at * kBatches * 3], &sums.batches[p * kBatches * 3], kBatches * 3);
    for (std::size_t k = 0; k < 2 && mattes_wanted_; ++k) {
      for (const MatteCount& count : sums.mattes[k][p]) {
        for (int half = 0; half < 2; ++half) add_matte(mattes_[k][at], count.id, half, count.samples[half]);
      }
    }
  }
  asked_[tile] = batch_samples;
  dropped_[tile] += sums.dropped;
}

std::uint64_t Film::dropped() const { return std::accumulate(dropped_.begin(), dropped_.end(), std::uint64_t{0}); }

int Film::batch_samples(int batch, int asked) const {
  return std::min(asked, samples_ / kBatches + (batch < samples_ % kBatches ? 1 : 0));
}

int Film::half_samples(std::size_t tile, int half) const {
  return batch_samples(half, asked_[tile][half]) + batch_samples(half + 2, asked_[tile][half]);
}

int Film::tile_samples(std::size_t tile) const { return half_samples(tile, 0) + half_samples(tile, 1); }

// Halves count the same even where one has more samples: each goes by the other's samples, a mean weighted by numbers
// of samples would go by its own.
std::array<double, 2> Film::half_weights(std::size_t tile) const {
  const int a = half_samples(tile, 0), b = half_samples(tile, 1);
  if (b == 0) return {a > 0 ? 1.0 / a : 0.0, 0};
  return {0.5 / a, 0.5 / b};
}

HalfStatistics Film::statistics(std::size_t tile, int half) const {
  const int n0 = batch_samples(half, asked_[tile][half]), n1 = batch_samples(half + 2, asked_[tile][half]);
  HalfStatistics s;
  if (n0 == 0 || n1 == 0) return s;
  for (int pixel = 0; pixel < tiles_[tile].pixels(); ++pixel) {
    const float* sums = &batches_[index(tile, pixel) * kBatches * 3];
    for (int c = 0; c < 3; ++c) {
      const double a = sums[3 * half + c], b = sums[3 * (half + 2) + c];
      s.value += (a + b) / (3 * (n0 + n1));
      s.variance += std::pow(a / n0 - b / n1, 2) / 3 * n0 * n1 / (n0 + n1);
    }
  }
  s.value /= tiles_[tile].pixels();
  s.variance /= tiles_[tile].pixels();
  return s;
}

// The batches' means m_b of n_b samples are taken to vary as σ²/n_b: σ² = Σ n_b (m_b − m)² / (batches − 1).
Film::PixelEstimate Film::estimate(std::size_t tile, int pixel) const {
  const float* sums = &batches_[index(tile, pixel) * kBatches * 3];
  const std::array<double, 2> weights = half_weights(tile);
  std::array<int, kBatches> n{};
  int all = 0, batches = 0;
  for (int b = 0; b < kBatches; ++b) {
    n[b] = batch_samples(b, asked_[tile][b & 1]);
    if (n[b] == 0) continue;
    ++batches;
    all += n[b];
  }
  PixelEstimate e;
  for (int half = 0; half < 2; ++half) {
    for (std::size_t c = 0; c < 3; ++c) {
      e.value[c] += weights[half] * (double(sums[3 * half + c]) + double(sums[3 * half + 6 + c]));
    }
  }
  if (batches < 2) return e;
  double share = 0;  // Σ (weight of a sample)², of the two halves
  for (int half = 0; half < 2; ++half) share += weights[half] * weights[half] * half_samples(tile, half);
  for (std::size_t c = 0; c < 3; ++c) {
    double total = 0, spread = 0;
    for (int b = 0; b < kBatches; ++b) total += double(sums[3 * b + c]);
    for (int b = 0; b < kBatches; ++b) {
      if (n[b] > 0) spread += n[b] * std::pow(double(sums[3 * b + c]) / n[b] - total / all, 2);
    }
    e.variance[c] = share / (batches - 1) * spread;
  }
  return e;
}

// A single sample of a pixel does not tell how far it is off.
std::optional<double> Film::relative_standard_error() const {
  if (samples_ < 2) return std::nullopt;
  double error = 0, value = 0;
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    for (int pixel = 0; pixel < tiles_[tile].pixels(); ++pixel) {
      const PixelEstimate e = estimate(tile, pixel);
      for (std::size_t c = 0; c < 3; ++c) {
        error += e.variance[c];
        value += e.value[c] * e.value[c];
      }
    }
  }
  return value > 0 ? std::sqrt(error / value) : 0;
}

void Film::finish_pixel(std::size_t tile, int pixel, float* out) const {
  const std::size_t at = index(tile, pixel);
  const std::array<double, 2> weights = half_weights(tile);
  const float *a = &layers_[at * 2 * stride_], *b = a + stride_;
  for (std::size_t c = 0; c < stride_; ++c) out[c] = held(weights[0] * double(a[c]) + weights[1] * double(b[c]));
  const float hits = out[3];
  for (const int first : {normal_, position_}) {
    for (int c = 0; first >= 0 && c < 3; ++c) out[first + c] = hits > 0 ? out[first + c] / hits : 0.0F;
  }
  if (depth_ >= 0) out[depth_] = hits > 0 ? out[depth_] / hits : kInfinity;
  if (samples_layer_ >= 0) out[samples_layer_] = float(tile_samples(tile));
  for (std::size_t k = 0; k < 2 && mattes_wanted_; ++k) write_mattes(mattes_[k][at], weights, out + matte_layers_[k]);
  if (variance_ < 0) return;
  const std::array<double, 3> variance = estimate(tile, pixel).variance;
  for (std::size_t c = 0; c < 3; ++c) out[std::size_t(variance_) + c] = held(variance[c]);
}

void Film::finish(Image& image) const {
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    for (int pixel = 0; pixel < tiles_[tile].pixels(); ++pixel) {
      finish_pixel(tile, pixel, &image.pixels[index(tile, pixel) * stride_]);
    }
  }
}

}  // namespace chiaro::renderer
