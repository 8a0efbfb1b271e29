#include "inverse/solve/packed_values.h"

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/io/gltf_uri.h"

namespace chiaro::inverse {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
std::string data_uri(const std::vector<T>& values) {
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return renderer::make_data_uri("application/octet-stream", bytes);
}

std::uint16_t half_bits(float value) { return Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(value)); }

std::uint16_t within(float value, float low, float high) {
  const float fraction = high > low ? (value - low) / (high - low) : 0;
  return std::uint16_t(std::lround(65535 * std::clamp(fraction, 0.0F, 1.0F)));
}

}  // namespace

std::string pack_floats(const std::vector<Vec3f>& values) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  return data_uri(values);
}

std::string pack_within(const std::vector<Vec3f>& positions, const renderer::Box3f& box) {
  std::vector<std::uint16_t> packed;
  packed.reserve(3 * positions.size());
  for (const Vec3f& p : positions) {
    packed.insert(packed.end(), {within(p.x, box.min.x, box.max.x), within(p.y, box.min.y, box.max.y),
                                 within(p.z, box.min.z, box.max.z)});
  }
  return data_uri(packed);
}

std::string pack_halves(const std::vector<Vec3f>& values, float scale) {
  std::vector<std::uint16_t> packed;
  packed.reserve(3 * values.size());
  for (const Vec3f& v : values) {
    packed.insert(packed.end(), {half_bits(v.x / scale), half_bits(v.y / scale), half_bits(v.z / scale)});
  }
  return data_uri(packed);
}

template <class Real>
std::string pack_bytes(const std::vector<Real>& values, double scale) {
  std::vector<std::uint8_t> packed;
  packed.reserve(values.size());
  for (const Real v : values) {
    packed.push_back(std::uint8_t(std::lround(255 * std::clamp(scale > 0 ? double(v) / scale : 0, 0.0, 1.0))));
  }
  return data_uri(packed);
}

template std::string pack_bytes(const std::vector<float>& values, double scale);
template std::string pack_bytes(const std::vector<double>& values, double scale);

std::string pack_indices(const std::vector<std::size_t>& indices) {
  return data_uri(std::vector<std::uint32_t>(indices.begin(), indices.end()));
}

std::string pack_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles) { return data_uri(triangles); }

}  // namespace chiaro::inverse
