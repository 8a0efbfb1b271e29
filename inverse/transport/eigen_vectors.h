#pragma once
// Between the renderer's vectors, floats, and those that inverse lighting computes with, doubles.

#include <Eigen/Core>

#include "renderer/core/vec.h"

namespace chiaro::inverse {

inline Eigen::Vector3d to_eigen(renderer::Vec3f v) { return {double(v.x), double(v.y), double(v.z)}; }
inline renderer::Vec3f to_vec3f(const Eigen::Vector3d& v) { return {float(v.x()), float(v.y()), float(v.z())}; }

}  // namespace chiaro::inverse
