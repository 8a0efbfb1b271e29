#pragma once
// Between the renderer's vectors, floats, and those that inverse lighting computes with, doubles.

#include <Eigen/Core>

#include "renderer/core/vec.h"

namespace chiaro::inverse {

inline Eigen::Vector3d to_eigen(renderer::Vec3f v) { return {double(v.x), double(v.y), double(v.z)}; }
inline renderer::Vec3f to_vec3f(const Eigen::Vector3d& v) { return {float(v.x()), float(v.y()), float(v.z())}; }

// As positions are given out. Each by itself through memory: g++ 12 takes three at once, to float and back, for nothing
// to do.
inline Eigen::Vector3d rounded_to_float(const Eigen::Vector3d& v) {
  Eigen::Vector3d rounded;
  for (int axis = 0; axis < 3; ++axis) {
    const volatile float value = float(v[axis]);
    rounded[axis] = double(value);
  }
  return rounded;
}

}  // namespace chiaro::inverse
