#include "inverse/target/paint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "renderer/core/error.h"
#include "renderer/core/world_limits.h"
#include "tests/inverse/target/surfaces.h"
#include "tests/support/code_scenes.h"

namespace chiaro::inverse {
namespace {

using tests::floor_receiver;
using tests::join;
using tests::make_floor;
using tests::make_sheet;
using tests::make_target;

constexpr Vec3f kBase{8, 4, 2};

// A dab in the middle of the floor that reaches its borders.
Stroke middle_dab(BrushMode mode, BrushFalloff falloff) {
  return {.mode = mode, .color = {1, 2, 3}, .radius = 0.5F, .falloff = falloff, .path = {{0.5F, 0, 0.5F}}};
}

PaintResult paint_floor(const Stroke& stroke, float unpainted_weight = 0.05F) {
  return paint(make_target(make_floor(), kBase), {StrokeBase::kCurrent, {stroke}}, {unpainted_weight});
}

void expect_near(Vec3f found, Vec3f expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5F) << "channel " << c;
}

struct FalloffCase {
  BrushFalloff falloff;
  float at_quarter, at_half, at_three_quarters, at_rim;
};

// smooth: 1 − 3x² + 2x³. gaussian: (exp(−4.5 x²) − exp(−4.5)) / (1 − exp(−4.5)).
constexpr FalloffCase kFalloffCases[] = {{BrushFalloff::kHard, 1, 1, 1, 1},
                                         {BrushFalloff::kSmooth, 0.84375F, 0.5F, 0.15625F, 0},
                                         {BrushFalloff::kGaussian, 0.7520855F, 0.3170658F, 0.0692195F, 0}};

TEST(Paint, AddsByEachFalloff) {
  for (const FalloffCase& expected : kFalloffCases) {
    SCOPED_TRACE(int(expected.falloff));
    const auto painted = paint_floor(middle_dab(BrushMode::kAdd, expected.falloff)).target.illumination;
    expect_near(painted[floor_receiver(4, 4)], {9, 6, 5});
    expect_near(painted[floor_receiver(5, 4)], kBase + expected.at_quarter * Vec3f{1, 2, 3});
    expect_near(painted[floor_receiver(4, 6)], kBase + expected.at_half * Vec3f{1, 2, 3});
    expect_near(painted[floor_receiver(1, 4)], kBase + expected.at_three_quarters * Vec3f{1, 2, 3});
    expect_near(painted[floor_receiver(4, 0)], kBase + expected.at_rim * Vec3f{1, 2, 3});
    expect_near(painted[floor_receiver(0, 0)], kBase);
  }
}

TEST(Paint, EachModeChangesValuesByItsFormula) {
  struct Case {
    BrushMode mode;
    Vec3f middle, half;  // strength 1 × opacity and 0.5 × opacity, opacity 0.5
  };
  const Case cases[] = {{BrushMode::kAdd, {8.5F, 5, 3.5F}, {8.25F, 4.5F, 2.75F}},
                        {BrushMode::kSet, {4.5F, 3, 2.5F}, {6.25F, 3.5F, 2.25F}},
                        {BrushMode::kMultiply, {8, 6, 4}, {8, 5, 3}},
                        {BrushMode::kErase, {4, 2, 1}, {6, 3, 1.5F}}};
  for (const Case& expected : cases) {
    SCOPED_TRACE(int(expected.mode));
    Stroke stroke = middle_dab(expected.mode, BrushFalloff::kSmooth);
    stroke.opacity = 0.5F;
    const auto painted = paint_floor(stroke).target.illumination;
    expect_near(painted[floor_receiver(4, 4)], expected.middle);
    expect_near(painted[floor_receiver(6, 4)], expected.half);
    expect_near(painted[floor_receiver(8, 8)], kBase);
  }
}

TEST(Paint, SetAndEraseAtFullStrengthLeaveNothingOfTheBase) {
  const std::size_t middle = floor_receiver(4, 4);
  const auto set = paint_floor(middle_dab(BrushMode::kSet, BrushFalloff::kHard)).target;
  EXPECT_EQ(set.illumination[middle], (Vec3f{1, 2, 3}));
  const auto erased = paint_floor(middle_dab(BrushMode::kErase, BrushFalloff::kHard)).target;
  EXPECT_EQ(erased.illumination[middle], (Vec3f{0, 0, 0}));
}

TEST(Paint, ValuesNeitherFallBelowZeroNorOverflow) {
  Stroke darken = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  darken.color = {-100, -1, 0};
  EXPECT_EQ(paint_floor(darken).target.illumination[floor_receiver(4, 4)], (Vec3f{0, 3, 2}));
  Stroke brighten = middle_dab(BrushMode::kMultiply, BrushFalloff::kHard);
  brighten.color = {renderer::kBrightest, 1, 1};
  EXPECT_EQ(paint_floor(brighten).target.illumination[floor_receiver(4, 4)], (Vec3f{renderer::kBrightest, 4, 2}));
}

// However finely both are sampled: a ball that stands on the floor is reached over the place where it does.
TEST(Paint, LargerBrushesReachWhatSmallerOnesDo) {
  for (const float max_edge : {0.4F, 0.2F, 0.1F}) {
    renderer::Scene scene;
    test::add_mesh(scene, test::rectangle({0, 0, 4}, {4, 0, 0}, {0, 0, -4}), test::lambert({1, 1, 1}), "floor");
    test::add_mesh(scene, test::sphere({2, 0.59F, 2}, 0.6F, 24), test::lambert({1, 1, 1}), "ball");
    const Target base = make_target(make_receivers(scene, {.max_edge = max_edge}), {});
    Stroke stroke{.mode = BrushMode::kSet, .color = {1, 2, 3}, .falloff = BrushFalloff::kHard, .path = {{0.5F, 0, 2}}};
    stroke.facing = false;
    for (const float radius : {6.0F, 60.0F, 6000.0F}) {
      stroke.radius = radius;
      const Target painted = paint(base, {StrokeBase::kBlack, {stroke}}, {}).target;
      const auto left = std::count(painted.illumination.begin(), painted.illumination.end(), Vec3f{});
      EXPECT_EQ(left, 0) << max_edge << ' ' << radius;
    }
  }
}

TEST(Paint, StrokesApplyInOrder) {
  Stroke set = middle_dab(BrushMode::kSet, BrushFalloff::kHard);
  Stroke halve = middle_dab(BrushMode::kErase, BrushFalloff::kHard);
  halve.opacity = 0.5F;
  const Target base = make_target(make_floor(), kBase);
  const auto set_first = paint(base, {StrokeBase::kCurrent, {set, halve}}, {});
  const auto set_last = paint(base, {StrokeBase::kCurrent, {halve, set}}, {});
  EXPECT_EQ(set_first.target.illumination[floor_receiver(4, 4)], (Vec3f{0.5F, 1, 1.5F}));
  EXPECT_EQ(set_last.target.illumination[floor_receiver(4, 4)], (Vec3f{1, 2, 3}));
  EXPECT_EQ(set_first.touched, (std::vector<std::size_t>{49, 49}));
}

TEST(Paint, ADabTouchesTheDisk) {
  // 49 points of the integer lattice lie within 4 of one of them.
  EXPECT_EQ(paint_floor(middle_dab(BrushMode::kAdd, BrushFalloff::kSmooth)).touched, std::vector<std::size_t>{49});
}

TEST(Paint, APathTouchesWhatIsNearItsSegments) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.radius = 0.125F;
  stroke.path = {{0.25F, 0, 0.5F}, {0.75F, 0, 0.5F}};
  const PaintResult result = paint_floor(stroke);
  EXPECT_EQ(result.touched, std::vector<std::size_t>{7 + 5 + 5});
  EXPECT_EQ(result.target.weight[floor_receiver(4, 5)], 1);      // beside the middle, far from both ends
  EXPECT_EQ(result.target.weight[floor_receiver(1, 4)], 1);      // beyond the start
  EXPECT_EQ(result.target.weight[floor_receiver(1, 5)], 0.05F);  // round caps leave the corner out
}

TEST(Paint, OverlappingSegmentsOfAStrokeCountOnce) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.path = {{0.25F, 0, 0.5F}, {0.75F, 0, 0.5F}, {0.25F, 0, 0.5F}, {0.25F, 0, 0.5F}};
  EXPECT_EQ(paint_floor(stroke).target.illumination[floor_receiver(4, 4)], (Vec3f{9, 6, 5}));
}

TEST(Paint, WeightsAreTheStrokesWhereTouchedAndElseTheUnpaintedOne) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.weight = 3;
  stroke.opacity = 0;
  const Target painted = paint_floor(stroke, 0.25F).target;
  EXPECT_EQ(painted.weight[floor_receiver(4, 4)], 3);
  EXPECT_EQ(painted.weight[floor_receiver(0, 0)], 0.25F);
  EXPECT_EQ(painted.illumination, std::vector<Vec3f>(81, kBase));
}

TEST(Paint, WithoutAnUnpaintedWeightThoseOfTheBaseStay) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.weight = 2e38F;
  Target base = make_target(make_floor(), kBase, 0.25F);
  base.weight[floor_receiver(8, 8)] = 3e38F;
  const Target painted = paint(base, {StrokeBase::kCurrent, {stroke}}, {std::nullopt}).target;
  EXPECT_EQ(painted.weight[floor_receiver(4, 4)], 2e38F);
  EXPECT_EQ(painted.weight[floor_receiver(0, 0)], 0.25F);
  EXPECT_EQ(painted.weight[floor_receiver(8, 8)], 3e38F);
}

TEST(Paint, UnpaintedWeightThatIsNoWeightIsAnError) {
  const auto stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  EXPECT_THROW(paint_floor(stroke, -1), renderer::Error);
  EXPECT_THROW(paint_floor(stroke, std::numeric_limits<float>::quiet_NaN()), renderer::Error);
}

TEST(Paint, StandardErrorShrinksWithWhatIsLeftOfTheTracedValue) {
  Target base = make_target(make_floor(), kBase);
  base.standard_error.assign(81, 0.5F);
  Stroke halve = middle_dab(BrushMode::kErase, BrushFalloff::kHard);
  halve.opacity = 0.5F;
  const Target erased = paint(base, {StrokeBase::kCurrent, {halve}}, {}).target;
  EXPECT_NEAR(erased.standard_error[floor_receiver(4, 4)], 0.25F, 1e-6F);
  EXPECT_EQ(erased.standard_error[floor_receiver(0, 0)], 0.5F);
  const Stroke add = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  const Target added = paint(base, {StrokeBase::kCurrent, {add}}, {}).target;
  EXPECT_NEAR(added.standard_error[floor_receiver(4, 4)], 0.5F, 1e-6F);
}

TEST(Paint, StandardErrorsStayNumbersWhateverTheGain) {
  Target base = make_target(make_floor(), kBase);
  base.standard_error.assign(81, 0.5F);
  Stroke brighten = middle_dab(BrushMode::kMultiply, BrushFalloff::kHard);
  brighten.color = {1e20F, 1e20F, 1e20F};
  const Target once = paint(base, {StrokeBase::kCurrent, {brighten}}, {}).target;
  EXPECT_FLOAT_EQ(once.standard_error[floor_receiver(4, 4)], 0.5e20F);
  const Target twice = paint(base, {StrokeBase::kCurrent, {brighten, brighten}}, {}).target;
  EXPECT_EQ(twice.standard_error[floor_receiver(4, 4)], renderer::kBrightest);
}

std::size_t count_painted(const Target& target, std::size_t first, std::size_t end) {
  std::size_t count = 0;
  for (std::size_t i = first; i < end; ++i) count += target.weight[i] == 1;
  return count;
}

// Of a hard stroke of radius 0.5 on black: how many receivers of the first `split` it touches, and how many of the
// rest.
std::pair<std::size_t, std::size_t> touched_on_both(const Receivers& receivers, std::size_t split,
                                                    std::vector<Vec3f> path, bool facing) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.path = std::move(path);
  stroke.facing = facing;
  const Target painted = paint(make_target(receivers, {}), {StrokeBase::kBlack, {stroke}}, {}).target;
  return {count_painted(painted, 0, split), count_painted(painted, split, receivers.size())};
}

using Counts = std::pair<std::size_t, std::size_t>;

// Faces down; finer than the top, so that the vertex nearest to most places on the top is one of the bottom.
Receivers make_board_bottom() { return make_sheet({0, -0.01F, 0}, {1, 0, 0}, {0, 0, 1}, 33); }

TEST(PaintFacing, OfAThinBoardTheSidePaintedFromAloneIsTouched) {
  const Receivers board = join(make_floor(), make_board_bottom());
  // 49 and 797 lattice points within 4 and 16 of one of them; below, 0.5 is measured along and 0.01 across.
  EXPECT_EQ(touched_on_both(board, 81, {{0.5F, 0, 0.5F}}, true), (Counts{49, 0}));
  EXPECT_EQ(touched_on_both(board, 81, {{0.5F, -0.01F, 0.5F}}, true), (Counts{0, 797}));
  EXPECT_EQ(touched_on_both(board, 81, {{0.5F, 0, 0.5F}}, false), (Counts{49, 0}));
}

TEST(PaintFacing, BetweenVerticesTheSurfaceDecidesNotTheNearestVertex) {
  const Receivers board = join(make_floor(), make_board_bottom());
  const Counts touched = touched_on_both(board, 81, {{0.59375F, 0, 0.59375F}}, true);
  EXPECT_GT(touched.first, 40U);
  EXPECT_EQ(touched.second, 0U);
}

// A floor and a wall along its border x = 0, facing each other.
Receivers make_corner() { return join(make_floor(), make_sheet({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 9)); }

TEST(PaintFacing, NearACornerOnlyTheSurfaceUnderTheBrushIsTouched) {
  const Counts on_floor = touched_on_both(make_corner(), 81, {{0.02F, 0, 0.5F}}, true);
  EXPECT_GT(on_floor.first, 0U);
  EXPECT_EQ(on_floor.second, 0U);
  const Counts on_wall = touched_on_both(make_corner(), 81, {{0, 0.02F, 0.5F}}, true);
  EXPECT_EQ(on_wall.first, 0U);
  EXPECT_GT(on_wall.second, 0U);
}

TEST(PaintFacing, OnTheEdgeItselfBothSurfacesAreTouched) {
  const Counts touched = touched_on_both(make_corner(), 81, {{0, 0, 0.5F}}, true);
  EXPECT_EQ(touched.first, touched.second);
  EXPECT_EQ(touched.first, 29U);  // half the disk of 49 with its diameter of 9
}

TEST(PaintFacing, APathOverACornerTakesEachSideWhereItLies) {
  const Counts touched = touched_on_both(make_corner(), 81, {{0.75F, 0, 0.5F}, {0, 0, 0.5F}, {0, 0.75F, 0.5F}}, true);
  EXPECT_EQ(touched.first, touched.second);
  EXPECT_GT(touched.first, 40U);
}

// The floor, its receivers' normals turned away from those at x = 0 more and more: cosine (8 − x) / 24 at x > 0.
Receivers make_bent_floor() {
  Receivers floor = make_floor();
  for (int x = 1; x <= 8; ++x) {
    const float cosine = float(8 - x) / 24;
    for (int z = 0; z <= 8; ++z) floor.normals[floor_receiver(x, z)] = {std::sqrt(1 - cosine * cosine), cosine, 0};
  }
  return floor;
}

TEST(PaintFacing, FadesWhereTheSurfaceTurnsAway) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.radius = 2;
  stroke.path = {{0, 0, 0.5F}};
  stroke.weight = 3;
  const auto painted = paint(make_target(make_bent_floor(), kBase), {StrokeBase::kCurrent, {stroke}}, {0.5F}).target;
  expect_near(painted.illumination[floor_receiver(0, 4)], kBase + Vec3f{1, 2, 3});
  for (int x = 1; x <= 8; ++x) {
    SCOPED_TRACE(x);
    const float t = std::min(1.0F, float(8 - x) / 24 / 0.2F), facing = t * t * (3 - 2 * t);
    expect_near(painted.illumination[floor_receiver(x, 4)], kBase + facing * Vec3f{1, 2, 3});
    EXPECT_NEAR(painted.weight[floor_receiver(x, 4)], 0.5F + facing * 2.5F, 1e-5F);
  }
  EXPECT_EQ(painted.weight[floor_receiver(8, 4)], 0.5F);
}

TEST(PaintFacing, WeightsOfTheBaseComeNearerToTheStrokesAsReceiversFaceIt) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.radius = 2;
  stroke.path = {{0, 0, 0.5F}};
  stroke.weight = 5;
  Target base = make_target(make_bent_floor(), kBase);
  for (std::size_t i = 0; i < base.weight.size(); ++i) base.weight[i] = 0.5F + float(i);
  const auto weight = paint(base, {StrokeBase::kCurrent, {stroke}}, {std::nullopt}).target.weight;
  for (int x = 1; x <= 8; ++x) {
    SCOPED_TRACE(x);
    const float t = std::min(1.0F, float(8 - x) / 24 / 0.2F), facing = t * t * (3 - 2 * t);
    const float before = base.weight[floor_receiver(x, 4)];
    EXPECT_NEAR(weight[floor_receiver(x, 4)], before + facing * (5 - before), 1e-4F);
  }
}

TEST(PaintFacing, PathsFarAwayTouchNothing) {
  EXPECT_EQ(touched_on_both(make_corner(), 81, {{1e30F, -1e38F, 3e38F}, {-3e38F, 3e38F, 50}}, true), (Counts{0, 0}));
  EXPECT_EQ(touched_on_both(make_corner(), 81, {{0, 40, 0}}, false), (Counts{0, 0}));
}

TEST(PaintFacing, WithoutTrianglesTheNearestReceiverDecides) {
  Receivers points = join(make_floor(), make_sheet({0, -0.01F, 0}, {1, 0, 0}, {0, 0, 1}, 9));
  points.triangles.clear();
  EXPECT_EQ(touched_on_both(points, 81, {{0.5F, 0, 0.5F}}, true), (Counts{49, 0}));
}

// A floor of 2 × 1 m, and on it at x = 1 a wall of two sheets, 4 cm apart and open below; it shares no vertex with the
// floor, and its lower end is `sunk` below it.
Receivers make_two_rooms(float sunk) {
  Receivers rooms = make_sheet({0, 0, 0}, {0, 0, 1}, {2, 0, 0}, 21);
  rooms = join(std::move(rooms), make_sheet({0.98F, -sunk, 0}, {0, 0, 1}, {0, 1, 0}, 8));
  return join(std::move(rooms), make_sheet({1.02F, -sunk, 1}, {0, 0, -1}, {0, 1, 0}, 8));
}

struct Found {
  float left = 0, right = 0, left_wall = 0, right_wall = 0;  // the largest weights painted
};

Found paint_two_rooms(float sunk, const Stroke& stroke) {
  const Receivers rooms = make_two_rooms(sunk);
  const Target painted = paint(make_target(rooms, {}), {StrokeBase::kBlack, {stroke}}, {0}).target;
  Found found;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const bool is_floor = i < 441, is_left = rooms.positions[i].x < 1;
    if (is_floor && std::abs(rooms.positions[i].x - 1) < 0.03F) continue;  // inside the wall
    float& largest = is_floor ? (is_left ? found.left : found.right) : is_left ? found.left_wall : found.right_wall;
    largest = std::max(largest, painted.weight[i]);
  }
  return found;
}

TEST(PaintAlongSurface, AWallOnAFloorKeepsPaintInItsRoom) {
  for (const float sunk : {0.0F, 0.0005F, 0.001F, 0.05F, -0.001F}) {
    SCOPED_TRACE(sunk);
    Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
    stroke.path = {{0.83F, 0, 0.47F}};
    for (const bool facing : {true, false}) {
      stroke.facing = facing;
      const Found found = paint_two_rooms(sunk, stroke);
      EXPECT_EQ(found.left, 1);
      EXPECT_EQ(found.right, 0);
      EXPECT_EQ(found.left_wall, facing ? 0 : 1);
      EXPECT_EQ(found.right_wall, 0);
    }
    stroke.distance = BrushDistance::kSpace;
    EXPECT_EQ(paint_two_rooms(sunk, stroke).right, 1);
  }
}

TEST(PaintAlongSurface, RoundTheRimOfABoardAsFarAsItIs) {
  const Vec3f x{1, 0, 0}, y{0, 0.125F, 0}, z{0, 0, 1};
  const Receivers top = make_floor(), bottom = make_sheet({0, -0.125F, 0}, x, z, 9);
  const Receivers rim = make_sheet({1, -0.125F, 1}, -1 * z, y, 9);
  const std::size_t first_of_bottom = top.size();
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.facing = false;
  stroke.path = {{0.75F, 0, 0.5F}};
  const Receivers board = join(join(top, bottom), rim);
  const auto weights = paint(make_target(board, {}), {StrokeBase::kBlack, {stroke}}, {0}).target.weight;
  for (std::size_t i = first_of_bottom; i < first_of_bottom + 81; ++i) {
    const Vec3f p = board.positions[i];
    const float around = std::hypot(0.25F + 0.125F + 1 - p.x, p.z - 0.5F);
    EXPECT_EQ(weights[i], around <= 0.5F ? 1 : 0) << p.x << " " << p.z;
  }
}

TEST(PaintAlongSurface, APathOfTwoPointsGoesThroughTheCorner) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.radius = 0.1F;
  stroke.path = {{0.75F, 0, 0.4F}, {0, 0.75F, 0.6F}};
  const auto weights = paint(make_target(make_corner(), {}), {StrokeBase::kBlack, {stroke}}, {0}).target.weight;
  EXPECT_EQ(weights[floor_receiver(0, 4)], 1);
  EXPECT_EQ(weights[floor_receiver(1, 4)], 1);
  EXPECT_EQ(weights[81 + 4 * 9], 1);      // on the wall, in the corner
  EXPECT_EQ(weights[81 + 4 * 9 + 1], 1);  // 0.125 up
}

TEST(PaintAlongSurface, PointsOffTheSurfaceGoToTheNearestOneThatFacesThem) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.path = {{0.5F, 0.3F, 0.5F}, {0.5F, 0.6F, 0.5F}};
  const PaintResult result = paint_floor(stroke);
  EXPECT_EQ(result.touched, std::vector<std::size_t>{49});
  EXPECT_EQ(result.far_points, (std::vector<std::vector<std::size_t>>{{1}}));
}

TEST(PaintMirrored, PathAndMirrorImageAreOneStroke) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.radius = 0.26F;
  stroke.path = {{0.25F, 0, 0.5F}};
  stroke.mirror = MirrorPlane{{0.5F, 3, 0}, {1, 0, 0}};
  const PaintResult result = paint_floor(stroke);
  EXPECT_EQ(result.touched, std::vector<std::size_t>{13 + 13 - 1});  // lattice points within 2 of one of them
  expect_near(result.target.illumination[floor_receiver(4, 4)], kBase + Vec3f{1, 2, 3});
  for (int z = 0; z <= 8; ++z) {
    for (int x = 0; x <= 8; ++x) {
      EXPECT_EQ(result.target.weight[floor_receiver(x, z)], result.target.weight[floor_receiver(8 - x, z)]);
    }
  }
}

// Beyond the floor's edge.
TEST(PaintMirrored, ImagesThatMissAllSurfacesAreTold) {
  Stroke stroke = middle_dab(BrushMode::kAdd, BrushFalloff::kHard);
  stroke.radius = 0.2F;
  stroke.path = {{0.25F, 0, 0.5F}, {0.95F, 0, 0.5F}};
  stroke.mirror = MirrorPlane{{1, 0, 0}, {1, 0, 0}};
  const PaintResult result = paint_floor(stroke);
  EXPECT_TRUE(result.far_points[0].empty());
  EXPECT_EQ(result.far_images, (std::vector<std::vector<std::size_t>>{{0}}));
}

TEST(PaintAlongSurface, ARadiusBeyondAllThereIsTouchesAllThatHangsTogether) {
  for (const float radius : {10.0F, 1e3F, 1e9F}) {
    Stroke stroke = middle_dab(BrushMode::kSet, BrushFalloff::kHard);
    stroke.radius = radius;
    const Target floor = make_target(make_floor(), kBase);
    EXPECT_EQ(paint(floor, {StrokeBase::kCurrent, {stroke}}, {}).touched[0], floor.receivers.size()) << radius;
  }
}

}  // namespace
}  // namespace chiaro::inverse
