#pragma once
// Small fixed-size vectors, matrices and boxes. Matrices are column-major, as in glTF; names say `target_from_source`.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace chiaro::renderer {

inline constexpr float kPi = 3.14159265358979323846F;
inline constexpr float kInvPi = 0.31830988618379067154F;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Vec2f {
  float x = 0, y = 0;
};

struct Vec3f {
  float x = 0, y = 0, z = 0;
  float& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  float operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  bool operator==(const Vec3f&) const = default;
};

struct Vec4f {
  float x = 0, y = 0, z = 0, w = 0;
};

inline Vec2f operator+(Vec2f a, Vec2f b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2f operator*(float s, Vec2f a) { return {s * a.x, s * a.y}; }
inline Vec4f operator+(Vec4f a, Vec4f b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
inline Vec4f operator*(float s, Vec4f a) { return {s * a.x, s * a.y, s * a.z, s * a.w}; }

inline Vec3f operator+(Vec3f a, Vec3f b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3f operator-(Vec3f a, Vec3f b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3f operator-(Vec3f a) { return {-a.x, -a.y, -a.z}; }
inline Vec3f operator*(Vec3f a, Vec3f b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3f operator*(float s, Vec3f a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vec3f operator*(Vec3f a, float s) { return s * a; }
inline Vec3f operator/(Vec3f a, float s) { return (1.0F / s) * a; }
inline Vec3f operator/(Vec3f a, Vec3f b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
inline Vec3f& operator+=(Vec3f& a, Vec3f b) { return a = a + b; }
inline Vec3f& operator*=(Vec3f& a, Vec3f b) { return a = a * b; }
inline Vec3f& operator*=(Vec3f& a, float s) { return a = s * a; }

inline float dot(Vec3f a, Vec3f b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3f cross(Vec3f a, Vec3f b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length_squared(Vec3f a) { return dot(a, a); }
inline float length(Vec3f a) { return std::sqrt(dot(a, a)); }
// The same square for values of light: those of very bright or very dim ones are no floats.
inline double squared_norm(Vec3f a) { return double(a.x) * a.x + double(a.y) * a.y + double(a.z) * a.z; }
inline Vec3f normalize(Vec3f a) { return a / length(a); }
// The same where floats have no square of its length; `otherwise` where it has no direction.
Vec3f unit_or(Vec3f a, Vec3f otherwise);
inline float max_component(Vec3f a) { return std::max({a.x, a.y, a.z}); }
inline float min_component(Vec3f a) { return std::min({a.x, a.y, a.z}); }
inline Vec3f min(Vec3f a, Vec3f b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
inline Vec3f max(Vec3f a, Vec3f b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
inline Vec3f abs(Vec3f a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }
inline bool is_finite(Vec3f a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline Vec3f lerp(float t, Vec3f a, Vec3f b) { return (1 - t) * a + t * b; }

// Where floats would round away or overflow: differences, products and long sums of Vec3f.
struct Vec3d {
  double x = 0, y = 0, z = 0;
  Vec3d() = default;
  Vec3d(double x_value, double y_value, double z_value) : x(x_value), y(y_value), z(z_value) {}
  explicit Vec3d(Vec3f a) : x(double(a.x)), y(double(a.y)), z(double(a.z)) {}
  explicit operator Vec3f() const { return {float(x), float(y), float(z)}; }
};

inline Vec3d operator+(const Vec3d& a, const Vec3d& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3d operator-(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3d operator*(double s, const Vec3d& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vec3d operator/(const Vec3d& a, double s) { return {a.x / s, a.y / s, a.z / s}; }
inline Vec3d& operator+=(Vec3d& a, const Vec3d& b) { return a = a + b; }
inline double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3d& a) { return std::hypot(a.x, a.y, a.z); }

// Relative luminance (Y) of a scene-linear Rec.709 colour.
inline float luminance(Vec3f rec709) { return dot(rec709, {0.2126F, 0.7152F, 0.0722F}); }

struct Box3f {
  Vec3f min{kInfinity, kInfinity, kInfinity};
  Vec3f max{-kInfinity, -kInfinity, -kInfinity};

  bool operator==(const Box3f&) const = default;
  bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  Vec3f extent() const { return empty() ? Vec3f{} : max - min; }
  Vec3f center() const { return 0.5F * (min + max); }
  float diagonal() const { return length(extent()); }
  void extend(Vec3f p) {
    min = chiaro::renderer::min(min, p);
    max = chiaro::renderer::max(max, p);
  }
  bool encloses(const Box3f& box) const { return contains(box.min) && contains(box.max); }
  bool contains(Vec3f p) const {
    return p.x >= min.x && p.y >= min.y && p.z >= min.z && p.x <= max.x && p.y <= max.y && p.z <= max.z;
  }
};

// A 4 x 4 matrix, column-major: entry (row, column) is m[4 * column + row].
struct Mat4f {
  std::array<float, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  float operator()(int row, int column) const { return m[4 * column + row]; }
  float& operator()(int row, int column) { return m[4 * column + row]; }
  Vec3f column(int c) const { return {m[4 * c], m[4 * c + 1], m[4 * c + 2]}; }
};

inline bool is_finite(const Mat4f& a) {
  return std::all_of(a.m.begin(), a.m.end(), [](float v) { return std::isfinite(v); });
}

Mat4f operator*(const Mat4f& a, const Mat4f& b);
Vec3f transform_point(const Mat4f& target_from_source, Vec3f p);
// Around the box's corners: around what is transformed of it, too, to the last bit, as rounding keeps the order.
Box3f transform_box(const Mat4f& target_from_source, const Box3f& box);
Vec3f transform_direction(const Mat4f& target_from_source, Vec3f d);
// By the inverse transpose of the upper 3 x 3 part; unit length; a singular matrix gives the zero vector.
Vec3f transform_normal(const Mat4f& target_from_source, Vec3f n);
// Inverse of an affine matrix; a singular one gives a matrix of zeros.
Mat4f inverse_affine(const Mat4f& a);
float determinant3(const Mat4f& a);
// From glTF's translation (metres), rotation (unit quaternion x, y, z, w) and scale.
Mat4f make_transform(Vec3f translation, Vec4f rotation, Vec3f scale);

// An orthonormal basis around a unit normal (Duff et al., Building an Orthonormal Basis, Revisited, 2017).
struct Frame3f {
  Vec3f tangent, bitangent, normal;
  explicit Frame3f(Vec3f n) : normal(n) {
    const float sign = std::copysign(1.0F, n.z);
    const float a = -1.0F / (sign + n.z);
    const float b = n.x * n.y * a;
    tangent = {1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3f world_from_local(Vec3f d) const { return d.x * tangent + d.y * bitangent + d.z * normal; }
  Vec3f local_from_world(Vec3f d) const { return {dot(d, tangent), dot(d, bitangent), dot(d, normal)}; }
};

}  // namespace chiaro::renderer
