#pragma once
// Arrays of numbers as data URIs of little-endian binary, small enough for a page that holds a whole scene.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/core/vec.h"

namespace chiaro::inverse {

using renderer::Vec3f;

// 32-bit floats, three per vector.
std::string pack_floats(const std::vector<Vec3f>& values);

// Unsigned 16-bit integers, three per position: 0 … 65535 from one side of the box to the other.
std::string pack_within(const std::vector<Vec3f>& positions, const renderer::Box3f& box);

// Half floats of values / scale, three per vector.
std::string pack_halves(const std::vector<Vec3f>& values, float scale);

// Unsigned 8-bit integers: 0 … 255 for 0 … scale.
template <class Real>
std::string pack_bytes(const std::vector<Real>& values, double scale);

// Unsigned 32-bit integers.
std::string pack_indices(const std::vector<std::size_t>& indices);
std::string pack_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace chiaro::inverse
