#include "renderer/core/vec.h"

#include <limits>

namespace chiaro::renderer {

Vec3f unit_or(Vec3f a, Vec3f otherwise) {
  const float square = length_squared(a);
  if (square >= std::numeric_limits<float>::min() && std::isfinite(square)) return normalize(a);
  const double l = std::sqrt(squared_norm(a));
  return l > 0 && std::isfinite(l) ? Vec3f{float(a.x / l), float(a.y / l), float(a.z / l)} : otherwise;
}

Mat4f operator*(const Mat4f& a, const Mat4f& b) {
  Mat4f product;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += double(a(row, k)) * b(k, column);
      product(row, column) = float(sum);
    }
  }
  return product;
}

Vec3f transform_point(const Mat4f& t, Vec3f p) {
  return p.x * t.column(0) + p.y * t.column(1) + p.z * t.column(2) + t.column(3);
}

Box3f transform_box(const Mat4f& t, const Box3f& box) {
  Box3f transformed;
  for (const float x : {box.min.x, box.max.x}) {
    for (const float y : {box.min.y, box.max.y}) {
      for (const float z : {box.min.z, box.max.z}) transformed.extend(transform_point(t, {x, y, z}));
    }
  }
  return transformed;
}

Vec3f transform_direction(const Mat4f& t, Vec3f d) { return d.x * t.column(0) + d.y * t.column(1) + d.z * t.column(2); }

float determinant3(const Mat4f& a) { return dot(a.column(0), cross(a.column(1), a.column(2))); }

Vec3f transform_normal(const Mat4f& t, Vec3f n) {
  // The cofactor matrix is the inverse transpose times the determinant.
  const Vec3f c0 = cross(t.column(1), t.column(2));
  const Vec3f c1 = cross(t.column(2), t.column(0));
  const Vec3f c2 = cross(t.column(0), t.column(1));
  return unit_or(std::copysign(1.0F, dot(t.column(0), c0)) * (n.x * c0 + n.y * c1 + n.z * c2), {});
}

Mat4f inverse_affine(const Mat4f& a) {
  const float det = determinant3(a);
  Mat4f inverse;
  if (det == 0 || !std::isfinite(det)) {
    inverse.m.fill(0);
    return inverse;
  }
  const Vec3f rows[3] = {cross(a.column(1), a.column(2)) / det, cross(a.column(2), a.column(0)) / det,
                         cross(a.column(0), a.column(1)) / det};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) inverse(row, column) = rows[row][column];
    inverse(row, 3) = -dot(rows[row], a.column(3));
  }
  return inverse;
}

Mat4f make_transform(Vec3f t, Vec4f q, Vec3f s) {
  Mat4f r;
  const float xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const float xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const float wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  const Vec3f columns[4] = {s.x * Vec3f{1 - 2 * (yy + zz), 2 * (xy + wz), 2 * (xz - wy)},
                            s.y * Vec3f{2 * (xy - wz), 1 - 2 * (xx + zz), 2 * (yz + wx)},
                            s.z * Vec3f{2 * (xz + wy), 2 * (yz - wx), 1 - 2 * (xx + yy)}, t};
  for (int c = 0; c < 4; ++c) {
    for (int row = 0; row < 3; ++row) r(row, c) = columns[c][row];
  }
  return r;
}

}  // namespace chiaro::renderer
