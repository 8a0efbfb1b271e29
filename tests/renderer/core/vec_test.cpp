#include "renderer/core/vec.h"

#include <gtest/gtest.h>

#include "renderer/core/sampler.h"

namespace chiaro::renderer {
namespace {

Vec3f random_vec(Sampler& sampler) {
  const Vec2f xy = sampler.next_2d();
  return {2 * xy.x - 1, 2 * xy.y - 1, 2 * sampler.next_1d() - 1};
}

// A well-conditioned affine matrix; mirrored where asked.
Mat4f random_affine(std::uint32_t number, bool mirrored) {
  Sampler sampler(1, 0, number);
  Mat4f m;
  do {
    for (int c = 0; c < 4; ++c) {
      const Vec3f column = random_vec(sampler);
      for (int row = 0; row < 3; ++row) m(row, c) = 2 * column[row];
    }
  } while (std::abs(determinant3(m)) < 0.5F);
  if ((determinant3(m) < 0) != mirrored) {
    for (int row = 0; row < 3; ++row) m(row, 0) = -m(row, 0);
  }
  return m;
}

void expect_near(Vec3f a, Vec3f b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

TEST(Vec, TransformedNormalStaysAcrossItsSurfaceAndOnItsSide) {
  // For every direction d: n' · (M d) has the sign of n · d, and is 0 where n · d is.
  for (std::uint32_t number = 0; number < 200; ++number) {
    const Mat4f m = random_affine(number, number % 2 == 1);
    Sampler sampler(2, number, 0);
    const Vec3f n = normalize(random_vec(sampler));
    const Vec3f transformed = transform_normal(m, n);
    EXPECT_NEAR(length(transformed), 1, 1e-5F);
    const Frame3f frame(n);
    EXPECT_NEAR(dot(transformed, transform_direction(m, frame.tangent)), 0, 1e-4F);
    EXPECT_NEAR(dot(transformed, transform_direction(m, frame.bitangent)), 0, 1e-4F);
    EXPECT_GT(dot(transformed, transform_direction(m, n)), 0);
  }
}

TEST(Vec, TransformedNormalOfTinyScalesIsUnitAndOfSingularOnesZero) {
  const Vec3f n = normalize(Vec3f{1, 2, 3});
  expect_near(transform_normal(make_transform({}, {0, 0, 0, 1}, {1e-4F, 1e-4F, 1e-4F}), n), n, 1e-5F);
  EXPECT_EQ(transform_normal(make_transform({}, {0, 0, 0, 1}, {0, 0, 1}), n), Vec3f{});
}

TEST(Vec, VectorsWhoseSquareIsNoFloatHaveADirection) {
  for (const float length : {1.0F, 1e-21F, 1e-30F, 1e-38F, 1e-43F, 1e21F, 1e38F}) {
    const Vec3f unit = unit_or(length * Vec3f{0.6F, 0, -0.8F}, {0, 1, 0});
    const float tolerance = length < 1e-38F ? 0.05F : 1e-6F;  // such floats have few digits
    EXPECT_NEAR(unit.x, 0.6F, tolerance) << length;
    EXPECT_EQ(unit.y, 0) << length;
    EXPECT_NEAR(unit.z, -0.8F, tolerance) << length;
    EXPECT_NEAR(renderer::length(unit), 1, 1e-6F) << length;
  }
  EXPECT_EQ(unit_or({0, 0, 0}, {0, 1, 0}), (Vec3f{0, 1, 0}));
  EXPECT_EQ(unit_or({NAN, 0, 0}, {0, 1, 0}), (Vec3f{0, 1, 0}));
  EXPECT_EQ(unit_or({0, INFINITY, 0}, {0, 1, 0}), (Vec3f{0, 1, 0}));
}

TEST(Vec, InverseUndoesTheMatrix) {
  for (std::uint32_t number = 0; number < 200; ++number) {
    const Mat4f m = random_affine(number, number % 2 == 0);
    const Mat4f product = inverse_affine(m) * m;
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) EXPECT_NEAR(product(row, column), row == column ? 1 : 0, 2e-5F);
    }
    Sampler sampler(3, number, 0);
    const Vec3f p = random_vec(sampler);
    expect_near(transform_point(inverse_affine(m), transform_point(m, p)), p, 2e-5F);
  }
}

TEST(Vec, InverseOfASingularMatrixIsZero) {
  const Mat4f inverse = inverse_affine(make_transform({1, 2, 3}, {0, 0, 0, 1}, {1, 0, 1}));
  for (const float entry : inverse.m) EXPECT_EQ(entry, 0);
}

TEST(Vec, ProductAppliesTheRightMatrixFirst) {
  for (std::uint32_t number = 0; number < 50; ++number) {
    const Mat4f a = random_affine(number, false), b = random_affine(number + 1000, true);
    const Vec3f p{0.3F, -0.7F, 0.5F};
    expect_near(transform_point(a * b, p), transform_point(a, transform_point(b, p)), 1e-5F);
  }
}

TEST(Vec, TransformScalesThenRotatesThenMoves) {
  // A quarter turn about +Y takes +X to -Z.
  const float half = std::sqrt(0.5F);
  const Mat4f m = make_transform({10, 20, 30}, {0, half, 0, half}, {2, 3, 4});
  expect_near(transform_point(m, {1, 0, 0}), {10, 20, 28}, 1e-5F);
  expect_near(transform_point(m, {0, 1, 0}), {10, 23, 30}, 1e-5F);
  expect_near(transform_point(m, {0, 0, 1}), {14, 20, 30}, 1e-5F);
  EXPECT_NEAR(determinant3(m), 24, 1e-4F);
  EXPECT_LT(determinant3(make_transform({}, {0, half, 0, half}, {-2, 3, 4})), 0);
}

TEST(Vec, FramesAreOrthonormalAndRightHanded) {
  std::vector<Vec3f> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, normalize(Vec3f{1e-4F, 0, -1})};
  for (std::uint32_t i = 0; i < 100; ++i) {
    Sampler sampler(4, i, 0);
    normals.push_back(normalize(random_vec(sampler)));
  }
  for (const Vec3f n : normals) {
    const Frame3f frame(n);
    EXPECT_NEAR(length(frame.tangent), 1, 1e-5F);
    EXPECT_NEAR(length(frame.bitangent), 1, 1e-5F);
    EXPECT_NEAR(dot(frame.tangent, n), 0, 1e-5F);
    expect_near(cross(frame.tangent, frame.bitangent), n, 1e-5F);
    const Vec3f d{0.2F, -0.5F, 0.8F};
    expect_near(frame.local_from_world(frame.world_from_local(d)), d, 1e-5F);
  }
}

TEST(Vec, TransformedBoxesHoldWhatIsTransformedToTheLastBit) {
  Sampler sampler(5, 0, 0);
  for (std::uint32_t number = 0; number < 100; ++number) {
    Box3f box;
    std::vector<Vec3f> points(100);
    for (Vec3f& p : points) box.extend(p = 1e3F * random_vec(sampler));
    const Mat4f m = random_affine(number, number % 2 == 0);
    for (const Vec3f p : points) EXPECT_TRUE(transform_box(m, box).contains(transform_point(m, p)));
  }
}

TEST(Vec, BoxesHoldWhatTheyWereExtendedBy) {
  Box3f box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.diagonal(), 0);
  box.extend({1, 2, 3});
  EXPECT_FALSE(box.empty());
  box.extend({-1, 5, 0});
  EXPECT_EQ(box.extent(), (Vec3f{2, 3, 3}));
  EXPECT_TRUE(box.contains({0, 2, 3}));
  EXPECT_FALSE(box.contains({0, 1.9F, 3}));
}

}  // namespace
}  // namespace chiaro::renderer
